#include "render/picture.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "render/legend.h"
#include "render/painter.h"
#include "render/png.h"

namespace toile {
namespace {

void require(bool good, const std::string& what) {
  if (!good) throw std::invalid_argument("picture: " + what);
}

void check_mesh(std::span<const Vec3> vertices, std::span<const Triangle> triangles, const std::string& name) {
  for (const Vec3& vertex : vertices) {
    require(vertex.allFinite(), name + " has a vertex that is not finite");
    require(vertex.cwiseAbs().maxCoeff() < 1e6, name + " has a vertex more than 1000 km away");
  }
  for (const Triangle& triangle : triangles)
    for (const int v : triangle)
      require(v >= 0 && std::size_t(v) < vertices.size(), name + " has a triangle with a vertex that does not exist");
}

void check_field(const ScalarField& field, const Subject& subject, const std::string& name) {
  require(field.per_vertex.empty() || field.per_vertex.size() == subject.vertices.size(),
          name + " needs one value per vertex");
  require(field.per_triangle.empty() || field.per_triangle.size() == subject.triangles.size(),
          name + " needs one value per triangle");
  require(field.per_vertex.empty() || field.per_triangle.empty(), name + " is given both per vertex and per triangle");
  for (const std::span<const double> values : {field.per_vertex, field.per_triangle})
    require(std::all_of(values.begin(), values.end(), [](double value) { return std::isfinite(value); }),
            name + " has a value that is not finite");
}

void check_subject(const Subject& subject) {
  check_mesh(subject.vertices, subject.triangles, "the garment");
  if (subject.body) check_mesh(subject.body->vertices, subject.body->triangles, "the body");
  require(subject.triangle_panel.empty() || subject.triangle_panel.size() == subject.triangles.size(),
          "triangle_panel needs one value per triangle");
  for (const int panel : subject.triangle_panel)
    require(panel >= 0 && (subject.panel_colors.empty() || std::size_t(panel) < subject.panel_colors.size()),
            "a triangle's panel has no colour");
  for (const auto& [a, b] : subject.seams)
    require(std::min(a, b) >= 0 && std::size_t(std::max(a, b)) < subject.vertices.size(),
            "a seam has a vertex that does not exist");
  check_field(subject.stretch, subject, "stretch");
  check_field(subject.contact, subject, "contact");
}

void check_options(const PictureOptions& options) {
  for (const int size : {options.width, options.height})
    require(size >= kMinPictureSize && size <= kMaxPictureSize, "width and height must be 16 to 4096 pixels");
  require(options.samples == 1 || options.samples == 4, "samples must be 1 or 4");
  require(std::isfinite(options.scale_max) && options.scale_max >= 0, "scale_max must be finite and not negative");
  require(options.view >= View::front && options.view <= View::top, "unknown view");
  require(options.overlay >= Overlay::fabric && options.overlay <= Overlay::wireframe, "unknown overlay");
}

std::optional<ColorScale> scale_for(const Subject& subject, const PictureOptions& options) {
  if (options.overlay != Overlay::stretch && options.overlay != Overlay::contact) return std::nullopt;
  const ScalarField& field = options.overlay == Overlay::stretch ? subject.stretch : subject.contact;
  const std::span<const double> values = field.per_vertex.empty() ? field.per_triangle : field.per_vertex;
  require(subject.triangles.empty() || !values.empty(), "the overlay's field is missing");
  return color_scale(options.overlay, values, options.scale_max);
}

}  // namespace

std::vector<std::uint8_t> render_png(const Subject& subject, const PictureOptions& options) {
  return std::move(render_pngs(subject, std::span(&options, 1)).front());
}

std::vector<std::vector<std::uint8_t>> render_pngs(const Subject& subject, std::span<const PictureOptions> pictures) {
  check_subject(subject);
  for (const PictureOptions& options : pictures) {
    check_options(options);
    scale_for(subject, options);
  }
  std::vector<std::vector<std::uint8_t>> files(pictures.size());
  // One backend after the other: a context stays current as long as its painter lives.
  for (const Backend backend : {Backend::automatic, Backend::osmesa, Backend::egl}) {
    std::optional<Painter> painter;
    for (std::size_t i = 0; i < pictures.size(); ++i) {
      const PictureOptions& options = pictures[i];
      if (options.backend != backend) continue;
      if (!painter) painter.emplace(backend, options.width, options.height);
      const std::optional<ColorScale> scale = scale_for(subject, options);
      std::vector<std::uint8_t> pixels = painter->paint(subject, options, scale);
      if (scale) draw_legend(*scale, pixels, options.width, options.height);
      files[i] = encode_png(pixels, options.width, options.height);
    }
  }
  return files;
}

}  // namespace toile
