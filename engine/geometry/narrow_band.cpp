#include "engine/geometry/narrow_band.h"

#include "engine/geometry/openvdb_templates.h"
#include "engine/parallel/parallel_for.h"

#include <openvdb/tools/MeshToVolume.h>

namespace toile {

namespace {

/// The triangles in units of voxels, as meshToVolume asks for them.
struct IndexSpaceMesh {
  const Positions& vertices;
  const std::vector<Triangle>& triangles;
  Vec3 origin;
  double voxel;

  size_t polygonCount() const { return triangles.size(); }
  size_t pointCount() const { return vertices.size(); }
  size_t vertexCount(size_t) const { return 3; }
  void getIndexSpacePoint(size_t polygon, size_t corner, openvdb::Vec3d& place) const {
    const Vec3 x = (vertices[triangles[polygon][corner]] - origin) / voxel;
    place = {x.x(), x.y(), x.z()};
  }
};

}  // namespace

std::vector<BandLeaf> narrow_band(const Positions& vertices, const std::vector<Triangle>& triangles, const Vec3& origin,
                                  double voxel, double half_width) {
  openvdb::initialize();
  const auto transform = openvdb::math::Transform::createLinearTransform(voxel);
  const auto width = static_cast<float>(half_width);
  const openvdb::Int32Grid::Ptr nearest = openvdb::Int32Grid::create(-1);
  const openvdb::FloatGrid::Ptr distances = openvdb::tools::meshToVolume<openvdb::FloatGrid>(
      IndexSpaceMesh{vertices, triangles, origin, voxel}, *transform, width, width,
      openvdb::tools::UNSIGNED_DISTANCE_FIELD, nearest.get());

  static_assert(openvdb::FloatTree::LeafNodeType::SIZE == BandLeaf::kVoxels);
  std::vector<const openvdb::FloatTree::LeafNodeType*> nodes;
  for (auto node = distances->tree().cbeginLeaf(); node; ++node) {
    if (!node->isEmpty()) nodes.push_back(&*node);
  }
  std::vector<BandLeaf> leaves(nodes.size());
  parallel_for_each(static_cast<int>(nodes.size()), 16, [&](int n) {
    const openvdb::Coord first = nodes[n]->origin();
    const auto* triangle = nearest->tree().probeConstLeaf(first);
    leaves[n].first = {first.x(), first.y(), first.z()};
    for (int voxel_index = 0; voxel_index < BandLeaf::kVoxels; ++voxel_index) {
      leaves[n].distance[voxel_index] = nodes[n]->getValue(voxel_index);
      leaves[n].triangle[voxel_index] = nodes[n]->isValueOn(voxel_index) ? triangle->getValue(voxel_index) : -1;
    }
  });
  return leaves;
}

}  // namespace toile
