#pragma once
// Pictures of a draped garment: the entry of render/. y is up, the body faces +z, lengths in metres.

#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "engine/mesh/triangle_mesh.h"
#include "engine/types.h"
#include "render/context.h"

namespace toile {

/// Where the camera stands: front looks along −z, back along +z, left sees the wearer's left side (+x), right the
/// other, three_quarter from front left of the wearer and a little above, top straight down with the front at the
/// bottom.
enum class View { front, back, left, right, three_quarter, top };

/// fabric: as it would look. stretch, contact: coloured by Subject::stretch or ::contact, with a legend.
/// wireframe: the edges of the mesh over light shading.
enum class Overlay { fabric, stretch, contact, wireframe };

/// sRGB, 0 to 255.
using Rgb = std::array<std::uint8_t, 3>;

/// One number per vertex (drawn interpolated) or per triangle (drawn flat); at most one of the two is given.
struct ScalarField {
  std::span<const double> per_vertex, per_triangle;
};

/// What is to be drawn; borrows everything, copies nothing. A garment without triangles and a missing body are fine.
struct Subject {
  std::span<const Vec3> vertices;       ///< of the garments [m]
  std::span<const Triangle> triangles;  ///< counter-clockwise seen from the right side of the fabric
  std::span<const int> triangle_panel;  ///< index into panel_colors; empty: all are panel 0
  std::span<const Rgb> panel_colors;    ///< of the fabric's right side; empty: a default for every panel
  /// Edges drawn as seams, besides those between triangles of different panels, which always are.
  std::span<const std::pair<int, int>> seams;
  ScalarField stretch;                 ///< stretch ratio minus one
  ScalarField contact;                 ///< contact force [N]
  const TriangleMesh* body = nullptr;  ///< drawn in neutral grey
};

struct PictureOptions {
  View view = View::front;
  Overlay overlay = Overlay::fabric;
  int width = 1024, height = 1024;  ///< [px], 16 to 4096
  int samples = 4;                  ///< anti-aliasing: 1 (none) or 4 a pixel
  Backend backend = Backend::automatic;
  /// End of the colour scale, in the field's own unit; 0: a round number at or above the 99th percentile of |value|.
  double scale_max = 0;
};

inline constexpr int kMinPictureSize = 16, kMaxPictureSize = 4096;
inline constexpr Rgb kDefaultFabricColor{70, 104, 148};

/// The picture as the bytes of a PNG file (8-bit sRGB). Same input, same bytes on the same backend and machine.
/// Throws std::invalid_argument for options out of range, indices out of range, sizes that do not match, a number that
/// is not finite, or an overlay whose field is missing; std::runtime_error when OpenGL can't be had. Thread-safe.
std::vector<std::uint8_t> render_png(const Subject& subject, const PictureOptions& options);

/// Several pictures of one subject, in order; cheaper than one by one, because contexts and shaders are made once.
std::vector<std::vector<std::uint8_t>> render_pngs(const Subject& subject, std::span<const PictureOptions> pictures);

}  // namespace toile
