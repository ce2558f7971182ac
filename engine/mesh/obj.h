#pragma once
// Wavefront OBJ from bytes and to bytes; no file is touched.

#include "engine/mesh/triangle_mesh.h"

#include <string>
#include <string_view>

namespace toile {

inline constexpr std::size_t kMaxMeshVertices = 2'000'000;
inline constexpr std::size_t kMaxMeshTriangles = 4'000'000;

/// Reads v, vt, f (the four index forms, negative indices, polygons as fans), g and o (the latest before a face names
/// its group), and the `stitch vertex from to t` lines of garment meshes (Codim-IPC; indices from 0, unlike faces).
/// vn, materials, `seam` counts and unknown keywords are passed over. corner_uv is empty unless every face has
/// texture coordinates. Positions and UVs in the file's own unit.
/// Throws InputError at `pointer` with code `bad_mesh_file` and the line's number for anything malformed, numbers that
/// are not finite, indices out of range, faces with a repeated vertex, and more than the limits above.
TriangleMesh read_obj(std::string_view text, const std::string& pointer = "");

/// Positions and UVs with as many digits as tell them apart, groups as g lines, stitches as stitch lines. read_obj()
/// gives the same mesh back, but for groups without triangles.
std::string write_obj(const TriangleMesh& mesh);

}  // namespace toile
