#include "engine/plausible_size.h"

#include "engine/contact/collision_mesh.h"
#include "engine/geometry/box.h"
#include "engine/geometry/flat_triangle.h"
#include "engine/mesh/sewing.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>

namespace toile {
namespace {

constexpr double kLongest = 2, kSmallest = 0.12;    // times the body's greatest extent, a panel and a garment
constexpr double kLongestPanel = 3;                 // [m]
constexpr double kSlightlyOff = 1.2, kFarOff = 10;  // in space over flat

Vec3 extent_of(const Cloth& cloth, const std::function<bool(int)>& counts) {
  Box box;
  for (std::size_t t = 0; t < cloth.triangles.size(); ++t)
    if (counts(cloth.triangle_panel[t]))
      for (int v : cloth.triangles[t]) box.extend(cloth.x[v]);
  return box.empty() ? Vec3(Vec3::Zero()) : Vec3(box.upper - box.lower);
}

}  // namespace

void check_size(Cloth& cloth, const BodyField& body) {
  if (cloth.seam_pairs.empty() || !(body.bounds().upper - body.bounds().lower).allFinite()) return;
  const double height = (body.bounds().upper - body.bounds().lower).maxCoeff();
  char text[240];
  for (std::size_t p = 0; p < cloth.panels.size(); ++p) {
    const double size = extent_of(cloth, [&](int panel) { return panel == static_cast<int>(p); }).maxCoeff();
    if (size <= kLongest * height) continue;
    std::snprintf(text, sizeof text, "panel '%.80s' is %.1f m long and the body %.2f m: are the pattern's units right?",
                  cloth.panels[p].name.c_str(), size, height);
    if (size > kLongestPanel)
      throw InputError("/garments/" + std::to_string(cloth.panels[p].garment), "implausible_size", text);
    cloth.warnings.push_back(std::string("implausible_size: ") + text);
  }
  const int garments = cloth.vertex_garment.empty() ? 0 : 1 + cloth.vertex_garment.back();
  for (int g = 0; g < garments; ++g) {
    const double size = extent_of(cloth, [&](int panel) { return cloth.panels[panel].garment == g; }).maxCoeff();
    if (size >= kSmallest * height) continue;
    std::snprintf(text, sizeof text,
                  "implausible_size: garment %d is %.2g m in its longest direction and the body %.2f m: are its units "
                  "right?",
                  g, size, height);
    cloth.warnings.emplace_back(text);
  }
}

void check_something_is_left(const Cloth& apart) {
  if (apart.seam_pairs.empty()) return;
  Cloth sewn = apart;
  merge_seams(sewn);
  const auto has_triangles = [&](const Cloth& cloth, int g) {
    return std::any_of(cloth.triangle_panel.begin(), cloth.triangle_panel.end(),
                       [&](int panel) { return cloth.panels[panel].garment == g; });
  };
  const int garments = apart.vertex_garment.empty() ? 0 : 1 + apart.vertex_garment.back();
  for (int g = 0; g < garments; ++g)
    if (!has_triangles(sewn, g))
      throw InputError(
          "/garments/" + std::to_string(g), "empty_garment",
          "Sewing leaves no triangle of the garment: are its edges too long for its panels, or their units "
          "wrong?");
}

void check_flat_size(Cloth& cloth, const std::vector<char>& given_as_mesh) {
  for (std::size_t g = 0; g < given_as_mesh.size(); ++g) {
    if (!given_as_mesh[g]) continue;
    double flat = 0, space = 0;
    for (std::size_t t = 0; t < cloth.triangles.size(); ++t) {
      if (cloth.panels[cloth.triangle_panel[t]].garment != static_cast<int>(g)) continue;
      const auto& [a, b, c] = cloth.triangles[t];
      flat += flat_area(cloth.flat[t]);
      space += 0.5 * (cloth.x[b] - cloth.x[a]).cross(cloth.x[c] - cloth.x[a]).norm();
    }
    const double ratio = std::sqrt(space / flat);
    if (ratio >= 1 / kSlightlyOff && ratio <= kSlightlyOff) continue;
    char text[240];
    std::snprintf(text, sizeof text,
                  "the mesh is %.3g times as large in space as its flat pattern, the UVs: is uv_unit_mm right?", ratio);
    if (!(ratio >= 1 / kFarOff && ratio <= kFarOff))
      throw InputError("/garments/" + std::to_string(g) + "/mesh", "implausible_uv_unit", text);
    cloth.warnings.push_back("implausible_uv_unit: garment " + std::to_string(g) + ": " + text);
  }
}

NearBody near_body(const Scene& scene, const Cloth& cloth) {
  NearBody near{{}, largest_body_offset(cloth, scene.solver.body_offset)};
  for (const Garment& garment : scene.garments)
    near.garments.push_back(std::all_of(garment.pins.begin(), garment.pins.end(),
                                        [](const Pin& pin) { return std::holds_alternative<PinAttached>(pin.hold); }));
  return near;
}

void rethrow_with_sizes(const InputError& error, const std::vector<std::string>& warnings) {
  std::vector<Problem> problems = error.problems();
  for (const std::string& warning : warnings)
    for (const std::string code : {"implausible_size", "implausible_uv_unit"})
      if (warning.rfind(code + ": ", 0) == 0) problems.push_back({"/garments", code, warning.substr(code.size() + 2)});
  throw InputError(std::move(problems));
}

}  // namespace toile
