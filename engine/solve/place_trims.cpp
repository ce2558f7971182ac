#include "engine/solve/place_trims.h"

#include "engine/mesh/cloth_builder.h"
#include "engine/mesh/pattern_pointer.h"
#include "engine/scene/problem.h"
#include "engine/solve/panel_point.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include <algorithm>
#include <optional>

namespace toile {
namespace {

constexpr double kHoleSpacing = 1.0 / 6;  // of a diameter, from the button's middle

/// The isometry nearest to how the flat pattern lies in space: columns are the images of u and v.
Eigen::Matrix<double, 3, 2> frame(const Cloth& cloth, std::size_t triangle) {
  const Triangle& v = cloth.triangles[triangle];
  const auto& f = cloth.flat[triangle];
  Mat2 flat;
  flat << f[1] - f[0], f[2] - f[0];
  Eigen::Matrix<double, 3, 2> edges;
  edges << cloth.x[v[1]] - cloth.x[v[0]], cloth.x[v[2]] - cloth.x[v[0]];
  const Eigen::Matrix<double, 3, 2> deformation = edges * flat.inverse();
  const Eigen::SelfAdjointEigenSolver<Mat2> stretch(deformation.transpose() * deformation);
  return deformation * stretch.operatorInverseSqrt();
}

int panel_index(const Cloth& cloth, std::size_t garment, const std::string& name) {
  for (std::size_t p = 0; p < cloth.panels.size(); ++p)
    if (cloth.panels[p].garment == static_cast<int>(garment) && cloth.panels[p].name == name)
      return static_cast<int>(p);
  return -1;
}

struct Hole {
  int panel;
  Vec2 at;  // as Cloth::flat
  PanelPoint point;
  std::string pointer;
};

PanelPoint point_or_problem(const Cloth& cloth, int panel, const Vec2& at, const std::string& pointer) {
  const std::optional<PanelPoint> point = find_on_panel(cloth, panel, at);
  if (!point)
    throw InputError(pointer, "trim_off_panel", "The trim is not, or not with all of its thread, on the panel.");
  return *point;
}

void place_trim(const Trim& trim, const std::vector<Hole>& holes, double spacing, const Cloth& cloth,
                Trimmings& trimmings) {
  const Button& button = trim.button;
  const Triangle& under = cloth.triangles[holes[0].point.triangle];
  const Vec3 normal = (cloth.x[under[1]] - cloth.x[under[0]]).cross(cloth.x[under[2]] - cloth.x[under[0]]).normalized();
  Mat3 axes;
  axes.col(0) = frame(cloth, holes[0].point.triangle).col(0);
  axes.col(1) = normal.cross(axes.col(0));
  axes.col(2) = normal;
  const double first_depth = 0.5 * (button.thickness + spacing);
  RigidTrim& placed = trimmings.trims.emplace_back();
  placed.body = disc_body(button.mass, button.diameter, button.thickness);
  placed.shape = disc_shape(button.diameter, button.thickness);
  placed.friction = trim.friction;
  placed.start.center = position(cloth, holes[0].point) + first_depth * normal;
  placed.start.orientation = Eigen::Quaterniond(axes).normalized();

  const double reach = kHoleSpacing * button.diameter / std::sqrt(2.0);
  for (std::size_t layer = 0; layer < holes.size(); ++layer) {
    const Eigen::Matrix<double, 3, 2> lies = frame(cloth, holes[layer].point.triangle);
    for (const double sx : {-1.0, 1.0})
      for (const double sy : {-1.0, 1.0}) {
        const Vec2 flat_offset = lies.transpose() * axes * Vec3(sx * reach, sy * reach, 0);
        const PanelPoint point =
            point_or_problem(cloth, holes[layer].panel, holes[layer].at + flat_offset, holes[layer].pointer);
        AttachmentStencil& spring = trimmings.attachments.emplace_back();
        spring.cloth = cloth.triangles[point.triangle];
        spring.weights = point.weights;
        spring.trim = static_cast<int>(trimmings.trims.size()) - 1;
        spring.point = {sx * reach, sy * reach, -first_depth - static_cast<double>(layer) * spacing};
        spring.stiffness = trim.stiffness / 4;
        spring.damping = trim.damping;
      }
  }
}

}  // namespace

void place_trims(const Scene& scene, const Cloth& sewn, Trimmings& trimmings) {
  for (std::size_t g = 0; g < scene.garments.size(); ++g)
    for (std::size_t k = 0; k < scene.garments[g].trims.size(); ++k) {
      const Trim& trim = scene.garments[g].trims[k];
      std::vector<Hole> holes;
      double spacing = 0;
      for (std::size_t h = 0; h < trim.holes.size(); ++h) {
        const std::string pointer = garment_pointer(g) + "/trims/" + std::to_string(k) + "/attach/" + std::to_string(h);
        const int panel = panel_index(sewn, g, trim.holes[h].panel);
        const Vec2 at = turned_to_grain(grain_of(scene.garments[g], trim.holes[h].panel), trim.holes[h].at);
        holes.push_back({panel, at, point_or_problem(sewn, panel, at, pointer), pointer});
        spacing = std::max(spacing, layer_spacing(scene.solver, sewn, panel));
      }
      place_trim(trim, holes, spacing, sewn, trimmings);
    }
}

void append_trims(const std::vector<RigidTrim>& trims, TriangleMesh& mesh) {
  for (const RigidTrim& trim : trims) {
    if (!trim.shape.solid) continue;
    const TriangleMesh surface = trim.shape.solid->surface();
    const int base = static_cast<int>(mesh.vertices.size());
    for (const Vec3& v : surface.vertices) mesh.vertices.push_back(trim.start.center + trim.start.orientation * v);
    for (const Triangle& t : surface.triangles) mesh.triangles.push_back({base + t[0], base + t[1], base + t[2]});
  }
}

}  // namespace toile
