#pragma once
// Small subjects with known looks, and PNG files read back.

#include <png.h>

#include <cmath>
#include <fstream>
#include <numbers>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "render/picture.h"

namespace toile::test {

struct Image {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgb;
  Rgb at(int x, int y) const {
    const std::uint8_t* p = &rgb[3 * (std::size_t(y) * width + x)];
    return {p[0], p[1], p[2]};
  }
};

inline Image decode(const std::vector<std::uint8_t>& file) {
  png_image header{};
  header.version = PNG_IMAGE_VERSION;
  if (!png_image_begin_read_from_memory(&header, file.data(), file.size())) throw std::runtime_error(header.message);
  header.format = PNG_FORMAT_RGB;
  Image image{int(header.width), int(header.height), std::vector<std::uint8_t>(PNG_IMAGE_SIZE(header))};
  if (!png_image_finish_read(&header, nullptr, image.rgb.data(), 0, nullptr)) throw std::runtime_error(header.message);
  return image;
}

inline Image draw(const Subject& subject, const PictureOptions& options) {
  return decode(render_png(subject, options));
}

/// What owns the arrays that a Subject borrows.
struct Garment {
  Positions vertices;
  std::vector<Triangle> triangles;
  std::vector<int> panel;
  std::vector<Rgb> colors;
  Subject subject() const {
    Subject s;
    s.vertices = vertices;
    s.triangles = triangles;
    s.triangle_panel = panel;
    s.panel_colors = colors;
    return s;
  }
};

/// An upright square of 1 m about (0, 1, 0) facing +z; its left and right halves (x < 0, x > 0) are panels 0 and 1.
inline Garment upright_square(const Rgb& left, const Rgb& right) {
  Garment g;
  for (const double y : {0.5, 1.5})
    for (const double x : {-0.5, 0.0, 0.5}) g.vertices.emplace_back(x, y, 0);
  g.triangles = {{0, 1, 4}, {0, 4, 3}, {1, 2, 5}, {1, 5, 4}};
  g.panel = {0, 0, 1, 1};
  g.colors = {left, right};
  return g;
}

/// A sphere of latitudes and longitudes, outward.
inline TriangleMesh sphere(const Vec3& centre, double radius, int rings) {
  TriangleMesh mesh;
  const int columns = 2 * rings;
  for (int i = 0; i <= rings; ++i)
    for (int j = 0; j < columns; ++j) {
      const double theta = std::numbers::pi * i / rings, phi = 2 * std::numbers::pi * j / columns;
      mesh.vertices.push_back(
          centre + radius * Vec3(std::sin(theta) * std::sin(phi), std::cos(theta), std::sin(theta) * std::cos(phi)));
    }
  for (int i = 0; i < rings; ++i)
    for (int j = 0; j < columns; ++j) {
      const int a = i * columns + j, b = i * columns + (j + 1) % columns;
      mesh.triangles.push_back({a, a + columns, b});
      mesh.triangles.push_back({b, a + columns, b + columns});
    }
  return mesh;
}

/// A bell skirt with `folds` folds, `rows` × `columns` vertices, right side outward.
inline Garment skirt(int rows, int columns, int folds) {
  Garment g;
  for (int i = 0; i < rows; ++i)
    for (int j = 0; j < columns; ++j) {
      const double down = double(i) / (rows - 1), phi = 2 * std::numbers::pi * j / columns;
      const double radius = 0.14 + 0.2 * down + 0.03 * down * std::cos(folds * phi);
      g.vertices.emplace_back(radius * std::sin(phi), 1.05 - 0.6 * down, radius * std::cos(phi));
    }
  for (int i = 0; i + 1 < rows; ++i)
    for (int j = 0; j < columns; ++j) {
      const int a = i * columns + j, b = i * columns + (j + 1) % columns;
      for (const Triangle& t : {Triangle{a, a + columns, b}, Triangle{b, a + columns, b + columns}}) {
        g.triangles.push_back(t);
        g.panel.push_back(j < columns / 2 ? 0 : 1);
      }
    }
  g.colors = {{70, 104, 148}, {70, 104, 148}};
  return g;
}

inline int largest_difference(const Rgb& a, const Rgb& b) {
  return std::max({std::abs(a[0] - b[0]), std::abs(a[1] - b[1]), std::abs(a[2] - b[2])});
}

/// Brightness that tells light from dark: green weighs most (Rec. 709 on code values).
inline double luma(const Rgb& c) { return 0.2126 * c[0] + 0.7152 * c[1] + 0.0722 * c[2]; }

/// How far the channels lie apart.
inline int chroma(const Rgb& c) { return std::max({c[0], c[1], c[2]}) - std::min({c[0], c[1], c[2]}); }

/// Number of pixels for which `holds` is true.
template <typename Predicate>
long count_pixels(const Image& image, Predicate holds) {
  long count = 0;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) count += holds(image.at(x, y));
  return count;
}

}  // namespace toile::test
