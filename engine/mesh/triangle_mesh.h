#pragma once
// A plain triangle mesh, as read from and written to files and as used for bodies and pictures.

#include "engine/types.h"

#include <string>
#include <utility>

namespace toile {

struct TriangleMesh {
  Positions vertices;                          ///< [m]
  std::vector<Triangle> triangles;             ///< counter-clockwise seen from outside
  std::vector<std::array<Vec2, 3>> corner_uv;  ///< per triangle corner, in the file's own unit; empty: none
  std::vector<int> triangle_group;             ///< index into group_names; empty: one unnamed group
  std::vector<std::string> group_names;        ///< `g` or `o` names of an OBJ, mesh names of a GLB
  /// Seam of a garment mesh: `vertex` meets the point (1 − t)·from + t·to of an edge (t = 0: the vertex `from`).
  struct Stitch {
    int vertex, from, to;
    double t;
  };
  std::vector<Stitch> stitches;  ///< `stitch v from to t` lines (data/cipc); empty: none
};

}  // namespace toile
