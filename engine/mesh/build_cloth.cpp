#include "engine/mesh/build_cloth.h"

#include "engine/mesh/cloth_builder.h"

#include <algorithm>
#include <cstdio>

namespace toile {
namespace {

// Sizes that no garment for people has; a pattern in millimetres labelled centimetres is ten times too large.
constexpr double kLargestGarment = 4.0;    // [m]
constexpr double kSmallestGarment = 0.05;  // [m]; a test strip of one panel may be smaller

std::string in_metres(double length) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), length < 0.1 ? "%.2g" : "%.3g", length);
  return text.data();
}

void warn_of_size(const Garment& garment, std::size_t index, std::size_t first_vertex, Cloth& cloth) {
  if (first_vertex == cloth.x.size()) return;
  Vec3 low = cloth.x[first_vertex], high = low;
  for (std::size_t v = first_vertex; v < cloth.x.size(); ++v) {
    low = low.cwiseMin(cloth.x[v]);
    high = high.cwiseMax(cloth.x[v]);
  }
  const Vec3 size = high - low;
  const double largest = size.maxCoeff();
  const auto* pattern = std::get_if<Pattern>(&garment.shape);
  const bool strip = pattern && pattern->panels.size() < 2;
  if (largest <= kLargestGarment && (largest >= kSmallestGarment || strip)) return;
  const std::string name = garment.name.empty() ? "garment " + std::to_string(index) : "garment " + garment.name;
  cloth.warnings.push_back("implausible_size: " + name + " is " + in_metres(size.y()) + " m tall and " +
                           in_metres(std::max(size.x(), size.z())) + " m wide: are its units right?");
}

}  // namespace

int fabric_of(const Garment& garment, const std::string& panel_name, const Fabric* panel_fabric, Cloth& cloth) {
  const auto chosen = garment.panel_fabrics.find(panel_name);
  const Fabric& fabric = chosen != garment.panel_fabrics.end() ? chosen->second
                         : panel_fabric                        ? *panel_fabric
                                                               : garment.fabric;
  const auto known = std::find(cloth.fabrics.begin(), cloth.fabrics.end(), fabric);
  if (known != cloth.fabrics.end()) return static_cast<int>(known - cloth.fabrics.begin());
  cloth.fabrics.push_back(fabric);
  return static_cast<int>(cloth.fabrics.size()) - 1;
}

double grain_of(const Garment& garment, const std::string& panel_name) {
  const auto chosen = garment.panel_grain.find(panel_name);
  return chosen != garment.panel_grain.end() ? chosen->second : garment.grain;
}

Vec2 turned_to_grain(double grain, const Vec2& drawn) {
  return grain == 0 ? drawn : Vec2(Eigen::Rotation2Dd(-grain) * drawn);
}

void turn_to_grain(double grain, std::array<Vec2, 3>& flat) {
  for (Vec2& corner : flat) corner = turned_to_grain(grain, corner);
}

Cloth build_cloth(const Scene& scene) {
  Cloth cloth;
  for (std::size_t g = 0; g < scene.garments.size(); ++g) {
    const Garment& garment = scene.garments[g];
    const std::size_t first_vertex = cloth.x.size(), first_triangle = cloth.triangles.size();
    const int index = static_cast<int>(g);
    if (const auto* pattern = std::get_if<Pattern>(&garment.shape)) {
      add_pattern(garment, *pattern, index, cloth);
    } else {
      add_garment_mesh(garment, std::get<GarmentMesh>(garment.shape), index, cloth);
    }
    cloth.vertex_garment.resize(cloth.x.size(), index);
    add_creases(garment, index, static_cast<int>(first_vertex), static_cast<int>(first_triangle), cloth);
    warn_of_size(garment, g, first_vertex, cloth);
  }
  for (std::size_t v = 0; v < cloth.x.size(); ++v) cloth.placed.push_back({static_cast<int>(v), cloth.x[v]});
  return cloth;
}

double smallest_edge_length(const Cloth& cloth) {
  double length = 0.1;
  for (const ClothPanel& panel : cloth.panels)
    if (panel.edge_length > 0) length = std::min(length, panel.edge_length);
  return length;
}

TriangleMesh surface_mesh(const Cloth& cloth) {
  TriangleMesh mesh;
  mesh.vertices = cloth.x;
  mesh.triangles = cloth.triangles;
  mesh.corner_uv = cloth.flat;
  mesh.triangle_group = cloth.triangle_panel;
  for (const ClothPanel& panel : cloth.panels) mesh.group_names.push_back(panel.name);
  return mesh;
}

}  // namespace toile
