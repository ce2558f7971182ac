#include "engine/mesh/cloth_builder.h"
#include "engine/mesh/conforming_seams.h"
#include "engine/mesh/pattern_pointer.h"
#include "engine/mesh/zippers.h"
#include "engine/scene/problem.h"

#include <algorithm>
#include <cmath>

namespace toile {
namespace {

/// Vertices that no triangle uses have no mass and are left out; returns the new index of each vertex, -1 if dropped.
std::vector<int> drop_unused(TriangleMesh& mesh) {
  std::vector<int> renumbered(mesh.vertices.size(), -1);
  for (const Triangle& triangle : mesh.triangles) {
    for (const int v : triangle) renumbered[static_cast<std::size_t>(v)] = 0;
  }
  Positions used;
  for (std::size_t v = 0; v < renumbered.size(); ++v) {
    if (renumbered[v] < 0) continue;
    renumbered[v] = static_cast<int>(used.size());
    used.push_back(mesh.vertices[v]);
  }
  mesh.vertices = std::move(used);
  for (Triangle& triangle : mesh.triangles) {
    for (int& v : triangle) v = renumbered[static_cast<std::size_t>(v)];
  }
  return renumbered;
}

void check(const GarmentMesh& shape, const std::string& pointer) {
  const TriangleMesh& mesh = shape.mesh;
  if (mesh.triangles.empty()) throw InputError(pointer, "empty_garment", "the garment's mesh has no triangles");
  if (mesh.corner_uv.size() != mesh.triangles.size()) {
    throw InputError(pointer, "missing_uv", "a garment mesh needs texture coordinates: they are its flat pattern");
  }
  const int count = static_cast<int>(mesh.vertices.size());
  const auto outside = [&](int v) { return v < 0 || v >= count; };
  for (const Triangle& triangle : mesh.triangles) {
    if (std::any_of(triangle.begin(), triangle.end(), outside)) {
      throw InputError(pointer, "vertex_out_of_range", "a triangle names a vertex that is not there");
    }
  }
  for (std::size_t s = 0; s < shape.seams.size(); ++s) {
    if (outside(shape.seams[s].first) || outside(shape.seams[s].second)) {
      throw InputError(pointer, "vertex_out_of_range",
                       "seam pair " + std::to_string(s) + " names a vertex that is not there");
    }
  }
  for (std::size_t s = 0; s < mesh.stitches.size(); ++s) {
    const TriangleMesh::Stitch& stitch = mesh.stitches[s];
    if (outside(stitch.vertex) || outside(stitch.from) || outside(stitch.to)) {
      throw InputError(pointer, "vertex_out_of_range",
                       "stitch " + std::to_string(s) + " names a vertex that is not there");
    }
  }
}

}  // namespace

void add_garment_mesh(const Garment& garment, const GarmentMesh& shape, int garment_index, Cloth& cloth) {
  const std::string pointer = garment_pointer(static_cast<std::size_t>(garment_index)) + "/mesh";
  check(shape, pointer);
  TriangleMesh mesh = shape.mesh;
  std::vector<std::pair<int, int>> pairs = conform_stitches(mesh, pointer);
  const std::size_t stitched = pairs.size();
  pairs.insert(pairs.end(), shape.seams.begin(), shape.seams.end());
  const std::size_t given = mesh.vertices.size();
  const std::vector<int> renumbered = drop_unused(mesh);
  if (mesh.vertices.size() < given) {
    cloth.warnings.push_back("unused_vertices: " + std::to_string(given - mesh.vertices.size()) +
                             " vertices of the garment's mesh are in no triangle and were left out");
  }

  const int base = static_cast<int>(cloth.x.size());
  const int first_panel = static_cast<int>(cloth.panels.size());
  if (mesh.group_names.empty()) mesh.group_names.push_back(garment.name.empty() ? "mesh" : garment.name);
  std::vector<double> grain;
  for (const std::string& name : mesh.group_names) {
    grain.push_back(grain_of(garment, name));
    cloth.panels.push_back({garment_index, name, "", fabric_of(garment, name, nullptr, cloth), 0.0});
  }
  cloth.x.insert(cloth.x.end(), mesh.vertices.begin(), mesh.vertices.end());
  std::vector<long> sides(mesh.group_names.size(), 0);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    Triangle triangle = mesh.triangles[t];
    for (int& v : triangle) v += base;
    std::array<Vec2, 3> flat = mesh.corner_uv[t];
    for (Vec2& corner : flat) corner *= shape.uv_unit;
    const int group = mesh.triangle_group.empty() ? 0 : mesh.triangle_group[t];
    turn_to_grain(grain[static_cast<std::size_t>(group)], flat);
    double& length = cloth.panels[static_cast<std::size_t>(first_panel + group)].edge_length;
    for (std::size_t i = 0; i < 3; ++i) length += (flat[(i + 1) % 3] - flat[i]).norm();
    sides[static_cast<std::size_t>(group)] += 3;
    cloth.triangles.push_back(triangle);
    cloth.flat.push_back(flat);
    cloth.triangle_panel.push_back(first_panel + group);
  }
  for (std::size_t group = 0; group < sides.size(); ++group) {
    cloth.panels[static_cast<std::size_t>(first_panel) + group].edge_length /=
        static_cast<double>(std::max(sides[group], 1L));
  }

  const int seam = static_cast<int>(cloth.seam_names.size());
  if (stitched > 0) cloth.seam_names.push_back("stitches");
  if (pairs.size() > stitched) cloth.seam_names.push_back("seams");
  for (std::size_t p = 0; p < pairs.size(); ++p) {
    const int a = renumbered[static_cast<std::size_t>(pairs[p].first)];
    const int b = renumbered[static_cast<std::size_t>(pairs[p].second)];
    if (a < 0 || b < 0) {
      throw InputError(pointer, "vertex_out_of_range", "a seam names a vertex that is in no triangle");
    }
    if (a != b) cloth.seam_pairs.push_back({a + base, b + base, seam + (p >= stitched && stitched > 0 ? 1 : 0)});
  }
  for (std::size_t z = 0; z < garment.zippers.size(); ++z) {
    std::array<std::vector<int>, 2> runs;
    for (std::size_t k = 0; k < 2; ++k) {
      for (const int v : std::get<PinVertices>(garment.zippers[z].sides[k]).vertices) {
        const int used = v < static_cast<int>(renumbered.size()) ? renumbered[static_cast<std::size_t>(v)] : -1;
        if (used < 0) {
          throw InputError(garment_pointer(static_cast<std::size_t>(garment_index)) + "/zippers/" + std::to_string(z) +
                               "/sides/" + std::to_string(k),
                           "vertex_out_of_range", "a zipper names a vertex that is in no triangle");
        }
        runs[k].push_back(used + base);
      }
    }
    add_zipper(garment.zippers[z], z, garment_index, runs, cloth);
  }
}

}  // namespace toile
