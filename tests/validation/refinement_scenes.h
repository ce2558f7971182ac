#pragma once
// What is draped at several edge lengths to see how the result settles: a sheet onto a sphere, over a table's edge,
// onto a cone, and a kerchief onto the dress form. Chosen so that the finest meshes resolve the fabric's bending
// length.

#include "tests/engine/solve/scenes.h"

#include <string>
#include <vector>

namespace toile::test {

/// A canvas of 22 mm bending length.
inline Fabric canvas() {
  Fabric fabric = isotropic_fabric(0.3, 1500, 200, 200, 3e-5);
  fabric.friction_cloth = 0.3;
  return fabric;
}

/// Closed cone of revolution, its apex up.
inline TriangleMesh cone_mesh(const Vec3& apex, double radius, double height, int sectors) {
  TriangleMesh mesh;
  mesh.vertices = {apex, apex - Vec3(0, height, 0)};
  for (int s = 0; s < sectors; ++s) {
    const double angle = 2 * std::numbers::pi * s / sectors;
    mesh.vertices.push_back(apex + Vec3(radius * std::sin(angle), -height, radius * std::cos(angle)));
  }
  for (int s = 0; s < sectors; ++s) {
    const int here = 2 + s, next = 2 + (s + 1) % sectors;
    mesh.triangles.push_back({0, here, next});
    mesh.triangles.push_back({1, next, here});
  }
  return mesh;
}

struct RefinementScene {
  std::string name;
  Scene scene;

  /// The same scene on a mesh of this edge length [m], brought to rest as well as the mesh is to show: what hangs
  /// freely is a pendulum, off by a hundredth of its length where a hundredth of its weight is not balanced.
  Scene at(double edge_length) const {
    Scene finer = scene;
    for (Garment& garment : finer.garments) garment.edge_length = edge_length;
    finer.solver.rest_residual = 1e-3;
    finer.solver.simulated_time_limit = 20;
    return finer;
  }
};

inline RefinementScene sphere_refinement() {
  Scene scene;
  scene.garments = {square_garment(0.3, 0.02, 0.003, canvas())};
  scene.body = Body{SphereBody{Vec3(0, -0.1, 0), 0.1}, 0.3};
  return {"sphere", scene};
}

/// A strip that lies on a table with half of its length and hangs over the edge with the other.
inline RefinementScene table_edge_refinement() {
  Scene scene;
  Panel strip = rectangle_panel("strip", 0.1, 0.3);
  strip.rotation = Eigen::AngleAxisd(-std::numbers::pi / 2, Vec3::UnitX()).toRotationMatrix();
  strip.translation = Vec3(0, 0.003, 0.15);
  Garment garment = garment_of(Pattern{{strip}, {}}, 0.02, "strip");
  garment.fabric = canvas();
  scene.garments = {garment};
  scene.body = Body{BoxBody{Vec3(0, -0.25, -0.25), Vec3(0.25, 0.25, 0.25), Mat3::Identity()}, 0.5};
  return {"table", scene};
}

inline RefinementScene cone_refinement() {
  Scene scene;
  scene.garments = {square_garment(0.3, 0.02, 0.003, canvas())};
  scene.body = Body{MeshBody{cone_mesh(Vec3::Zero(), 0.1, 0.06, 96)}, 0.3};
  return {"cone", scene};
}

/// A kerchief dropped onto the neck and shoulders of the dress form. Nothing is sewn or pinned: where a waist is held
/// depends on the sewing, which differs from mesh to mesh by more than the drape.
inline RefinementScene body_refinement() {
  Scene scene;
  scene.garments = {square_garment(0.4, 0.02, 1.53, canvas())};
  scene.body = Body{DressFormBody{}, 0.3};
  return {"body", scene};
}

inline std::vector<RefinementScene> refinement_scenes() {
  return {table_edge_refinement(), sphere_refinement(), cone_refinement(), body_refinement()};
}

}  // namespace toile::test
