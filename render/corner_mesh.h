#pragma once
// The subject as the graphics card takes it: three corners a triangle, each with its own normal, colour and distances
// to the triangle's marked edges.

#include <optional>
#include <vector>

#include "render/legend.h"
#include "render/picture.h"

namespace toile {

/// A triangle's corner. `edge[i]` is the corner's distance [m] to the edge opposite corner i where that edge is marked
/// (a seam, or every edge in a wireframe), kFar otherwise; interpolated, it is the exact distance inside the triangle.
struct Corner {
  float position[3], normal[3];
  std::uint8_t color[4];  ///< sRGB
  float scalar;           ///< place on the colour scale, 0 to 1
  float edge[3];
};
inline constexpr float kFar = 1e3f;

/// Angle-weighted vertex normals, zero where no triangle with an area meets the vertex.
Positions vertex_normals(std::span<const Vec3> vertices, std::span<const Triangle> triangles);

/// The garment's corners about `origin`. Normals are smooth within a panel and half creased where panels meet.
std::vector<Corner> garment_corners(const Subject& subject, Overlay overlay, const std::optional<ColorScale>& scale,
                                    const Vec3& origin);

/// The body's corners about `origin`.
std::vector<Corner> body_corners(const TriangleMesh& body, const Vec3& origin);

/// A horizontal square of half side `radius` at height `y` about `centre`.
std::vector<Corner> ground_corners(const Vec3& centre, double y, double radius);

}  // namespace toile
