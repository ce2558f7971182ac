#pragma once
// glTF 2.0 binary (GLB) from bytes and to bytes; no file is touched, external references are refused.

#include "engine/mesh/triangle_mesh.h"

#include <string>
#include <string_view>

namespace toile {

/// Reads every triangle primitive of the default scene (or of all nodes, where there is no scene), node transforms
/// applied: POSITION, indices, TEXCOORD_0. Vertices at the same position within a mesh whose primitive repeats them for
/// the sake of UVs or normals are united again. Groups are mesh names. corner_uv is empty unless all primitives have
/// UVs; v is turned to point up, as in OBJ. Positions in metres as the format says.
/// Throws InputError at `pointer` with `bad_mesh_file` for anything but a sound GLB within the limits of obj.h.
TriangleMesh read_glb(std::string_view bytes, const std::string& pointer = "");

/// One node "garment" (a double-sided material; smooth normals, UVs) and, where `body` is not null and not empty, one
/// node "body". Positions in float. A vertex is repeated where its UVs differ.
std::string write_glb(const TriangleMesh& garment, const TriangleMesh* body = nullptr);

}  // namespace toile
