#include "engine/experiments/specimen.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace toile {

double angle_of(Direction direction) {
  switch (direction) {
    case Direction::warp:
      return std::numbers::pi / 2;
    case Direction::weft:
      return 0;
    case Direction::bias:
      return std::numbers::pi / 4;
  }
  return 0;
}

Garment specimen(const std::string& name, const FlatMesh& mesh, const Placement& place, double angle,
                 const Fabric& fabric, double edge_length) {
  const Eigen::Rotation2Dd turn(angle);
  GarmentMesh shape;
  for (const Vec2& p : mesh.vertices) shape.mesh.vertices.push_back(place(p));
  shape.mesh.triangles = mesh.triangles;
  for (const Triangle& t : mesh.triangles)
    shape.mesh.corner_uv.push_back(
        {turn * mesh.vertices[t[0]], turn * mesh.vertices[t[1]], turn * mesh.vertices[t[2]]});
  Garment garment;
  garment.name = name;
  garment.shape = std::move(shape);
  garment.fabric = fabric;
  garment.edge_length = edge_length;
  return garment;
}

FlatMesh strip_mesh(double length, double width, double edge_length) {
  const std::array<Vec2, 5> corners = {Vec2(0, 0), Vec2(length, 0), Vec2(length, width), Vec2(0, width), Vec2(0, 0)};
  std::vector<Vec2> outline;
  for (std::size_t side = 0; side < 4; ++side) {
    const Vec2 from = corners[side], to = corners[side + 1];
    const int parts = std::max(1, static_cast<int>(std::ceil((to - from).norm() / edge_length - 1e-9)));
    for (int k = 0; k < parts; ++k) outline.emplace_back(from + (to - from) * k / parts);
  }
  return mesh_polygon(outline, edge_length);
}

std::vector<int> vertices_at(const FlatMesh& mesh, double along) {
  std::vector<int> found;
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v)
    if (std::abs(mesh.vertices[v].x() - along) < 1e-9) found.push_back(static_cast<int>(v));
  return found;
}

Scene experiment_scene(Garment specimen, int threads) {
  Scene scene;
  scene.garments.push_back(std::move(specimen));
  scene.solver.relaxation_time = 0;
  scene.solver.max_time_step = 5e-3;
  scene.solver.simulated_time_limit = 30;
  scene.solver.rest_residual = 0.01;
  scene.solver.threads = threads;
  return scene;
}

Drape drape_specimen(const Scene& scene, Monitor& monitor) {
  Drape result = drape(scene, monitor);
  std::erase_if(result.report.warnings, [](const std::string& w) { return w.starts_with("implausible_size"); });
  return result;
}

}  // namespace toile
