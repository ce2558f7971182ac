#pragma once
// One picture in five passes (see README.md), on one context.

#include <memory>
#include <optional>
#include <vector>

#include "render/camera.h"
#include "render/corner_mesh.h"
#include "render/gl_objects.h"

namespace toile {

/// A context with its programs; draws any number of pictures. To be used on the thread that made it.
class Painter {
 public:
  Painter(Backend backend, int width, int height);
  Painter(const Painter&) = delete;  // the objects point to gl_
  Painter& operator=(const Painter&) = delete;

  /// The picture's sRGB pixels, 3·width·height bytes, top row first, without a legend.
  std::vector<std::uint8_t> paint(const Subject& subject, const PictureOptions& options,
                                  const std::optional<ColorScale>& scale);

 private:
  struct Scene;
  struct Targets;
  VertexBuffer upload(const std::vector<Corner>& corners) const;
  void draw_mesh(const GlObject& program, const VertexBuffer& mesh, double inset) const;
  void draw_shadow_map(const Scene& scene, const Targets& targets) const;
  void draw_geometry(const Scene& scene, const Targets& targets) const;
  void draw_light(const Scene& scene, const Targets& targets) const;
  void draw_surfaces(const Scene& scene, const Targets& targets, const PictureOptions& options, bool mapped) const;
  std::vector<std::uint8_t> encode(const Targets& targets, int width, int height) const;

  std::unique_ptr<Context> context_;
  Gl gl_;
  GlObject depth_, geometry_, occlusion_, light_, background_, surface_, encode_, screen_;
};

}  // namespace toile
