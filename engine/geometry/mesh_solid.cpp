#include "engine/geometry/mesh_solid.h"

#include "engine/geometry/distance_grid.h"
#include "engine/geometry/overhangs.h"
#include "engine/geometry/solid_surface.h"

#include <algorithm>
#include <cmath>

namespace toile {

namespace {

constexpr double kFinest = 0.002, kWidest = 0.006;  ///< [m]
constexpr double kMostFineNodes = 25e6;             ///< 100 MB
constexpr double kMostCoarseNodes = 4e6;            ///< 16 MB
constexpr double kMargin = 0.08;                    ///< [m], the exterior band
/// Nodes per cell of surface area, as met on bodies, with those that bricks share.
constexpr double kNodesPerArea = 45;

GridSettings settings_for(const TriangleMesh& mesh, double edge_length) {
  const Box box = bounding_box(mesh.vertices);
  const Vec3 size = box.upper - box.lower;
  double area = 0;
  for (const auto& [a, b, c] : mesh.triangles) {
    area += 0.5 * (mesh.vertices[b] - mesh.vertices[a]).cross(mesh.vertices[c] - mesh.vertices[a]).norm();
  }
  GridSettings settings;
  settings.fine_spacing =
      std::max(std::clamp(edge_length / 3, kFinest, kWidest), std::sqrt(kNodesPerArea * area / kMostFineNodes));
  settings.margin = std::max(kMargin, 5 * settings.fine_spacing);
  settings.coarse_spacing =
      std::max(2.5 * settings.fine_spacing, std::cbrt((size.array() + 2 * settings.margin).prod() / kMostCoarseNodes));
  return settings;
}

class MeshSolid final : public Solid {
 public:
  MeshSolid(SoupSolid solid, TriangleMesh surface, std::vector<std::string> warnings, const GridSettings& settings)
      : solid_(std::move(solid)),
        surface_(std::move(surface)),
        warnings_(std::move(warnings)),
        bounds_(bounding_box(solid_.vertices)),
        grid_(solid_, settings) {}

  double distance(const Vec3& point) const override { return grid_.distance(point); }
  FieldSample sample(const Vec3& point) const override { return grid_.sample(point); }
  double band() const override { return grid_.settings().margin; }
  Box bounds() const override { return bounds_; }
  TriangleMesh surface() const override { return surface_; }
  std::vector<std::string> warnings() const override { return warnings_; }

  std::shared_ptr<const Solid> without_overhangs() const override {
    std::optional<SoupSolid> standing = cut_overhangs(solid_, grid_);
    if (!standing || standing->triangles.empty()) return nullptr;
    TriangleMesh surface;
    surface.vertices = standing->vertices;
    surface.triangles = standing->triangles;
    return std::make_shared<MeshSolid>(std::move(*standing), std::move(surface), warnings_, grid_.settings());
  }

 private:
  SoupSolid solid_;
  TriangleMesh surface_;
  std::vector<std::string> warnings_;
  Box bounds_;
  DistanceGrid grid_;
};

}  // namespace

std::shared_ptr<const Solid> make_mesh_solid(const TriangleMesh& mesh, double edge_length) {
  const GridSettings settings = settings_for(mesh, edge_length);
  SolidSurface made = make_solid_surface(mesh, settings.fine_spacing);
  return std::make_shared<MeshSolid>(std::move(made.solid), std::move(made.oriented), std::move(made.warnings),
                                     settings);
}

}  // namespace toile
