#include "render/painter.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <stdexcept>

namespace toile {
namespace {

constexpr int kShadowSize = 2048;          // [px] about 1 mm a texel for a standing body
constexpr double kOcclusionRadius = 0.07;  // [m] the size of folds
constexpr double kOcclusionShare = 0.15;   // of the subject's radius at most
constexpr double kBodyInset = 0.001;       // [m] hides that a coarse cloth's chords cut into a curved body
constexpr double kGroundDrop = 0.002;      // [m] below the lowest point: no fight with a body's own floor
constexpr double kGroundReach = 2.2;       // ground's radius over the subject's
constexpr double kSeamHalfWidth = 0.0011;  // [m]
constexpr double kSeamHalfPixels = 0.55, kSeamStrength = 0.48, kSeamRim = 0.06;
constexpr double kWireHalfWidth = 0.0002, kWireHalfPixels = 0.6, kWireStrength = 0.75;
constexpr int kMapTexels = 256;

constexpr PixelFormat kColorPixels{GL_RGBA16F, GL_RGBA, GL_HALF_FLOAT};
constexpr PixelFormat kGeometryPixels{GL_RGBA32F, GL_RGBA, GL_FLOAT};
constexpr PixelFormat kOcclusionPixels{GL_R16F, GL_RED, GL_HALF_FLOAT};
constexpr PixelFormat kDepthPixels{GL_DEPTH_COMPONENT32F, GL_DEPTH_COMPONENT, GL_FLOAT};
constexpr PixelFormat kFinalPixels{GL_RGBA8, GL_RGBA, GL_UNSIGNED_BYTE};
constexpr PixelFormat kMapPixels{GL_SRGB8_ALPHA8, GL_RGB, GL_UNSIGNED_BYTE};

// Sets uniforms of the program in use; a name that the compiler dropped is ignored by OpenGL.
class Uniforms {
 public:
  Uniforms(const Gl& gl, const GlObject& program) : gl_(gl), program_(program.id()) { gl.UseProgram(program_); }
  const Uniforms& set(const char* name, double value) const {
    gl_.Uniform1f(at(name), static_cast<float>(value));
    return *this;
  }
  const Uniforms& set(const char* name, int value) const {
    gl_.Uniform1i(at(name), value);
    return *this;
  }
  const Uniforms& set(const char* name, double x, double y) const {
    gl_.Uniform2f(at(name), static_cast<float>(x), static_cast<float>(y));
    return *this;
  }
  const Uniforms& set(const char* name, const Vec3& value) const {
    const Eigen::Vector3f single = value.cast<float>();
    gl_.Uniform3fv(at(name), 1, single.data());
    return *this;
  }
  const Uniforms& set(const char* name, const Eigen::Matrix4f& value) const {
    gl_.UniformMatrix4fv(at(name), 1, GL_FALSE, value.data());
    return *this;
  }
  const Uniforms& texture(const char* name, int unit, const GlObject& bound) const {
    gl_.ActiveTexture(GL_TEXTURE0 + unit);
    gl_.BindTexture(GL_TEXTURE_2D, bound.id());
    return set(name, unit);
  }

 private:
  GLint at(const char* name) const { return gl_.GetUniformLocation(program_, name); }

  const Gl& gl_;
  GLuint program_;
};

GlObject make_color_map(const Gl& gl, const std::optional<ColorScale>& scale) {
  std::vector<Rgb> texels(kMapTexels, Rgb{0, 0, 0});
  if (scale)
    for (int i = 0; i < kMapTexels; ++i) texels[i] = scale->color(i / (kMapTexels - 1.0));
  return make_texture(gl, kMapPixels, kMapTexels, 1, GL_LINEAR, texels.data());
}

}  // namespace

struct Painter::Scene {
  Camera camera;
  KeyLight light;
  double radius, ground_radius;
  Vec3 ground_centre;
  VertexBuffer garment, body, ground;
  GlObject color_map;
};

// Textures and framebuffers of one picture, at `width` × `height` drawn pixels.
struct Painter::Targets {
  Targets(const Gl& gl, int wide, int high, int samples, int scale_down)
      : width(wide),
        height(high),
        scale(scale_down),
        shadow(make_texture(gl, kDepthPixels, kShadowSize, kShadowSize, GL_LINEAR, nullptr)),
        geometry(make_texture(gl, kGeometryPixels, width, height, GL_NEAREST, nullptr)),
        depth(make_texture(gl, kDepthPixels, width, height, GL_NEAREST, nullptr)),
        occlusion(make_texture(gl, kOcclusionPixels, width, height, GL_NEAREST, nullptr)),
        light(make_texture(gl, kGeometryPixels, width, height, GL_NEAREST, nullptr)),
        resolved(make_texture(gl, kColorPixels, width, height, GL_NEAREST, nullptr)),
        final(make_texture(gl, kFinalPixels, width / scale, height / scale, GL_NEAREST, nullptr)),
        many_colors(make_renderbuffer(gl, GL_RGBA16F, samples, width, height)),
        many_depths(make_renderbuffer(gl, GL_DEPTH_COMPONENT32F, samples, width, height)),
        shadow_frame(make_framebuffer(gl, nullptr, &shadow)),
        geometry_frame(make_framebuffer(gl, &geometry, &depth)),
        occlusion_frame(make_framebuffer(gl, &occlusion, nullptr)),
        light_frame(make_framebuffer(gl, &light, nullptr)),
        many_frame(make_multisampled_framebuffer(gl, many_colors, many_depths)),
        resolved_frame(make_framebuffer(gl, &resolved, nullptr)),
        final_frame(make_framebuffer(gl, &final, nullptr)) {
    gl.BindTexture(GL_TEXTURE_2D, shadow.id());
    gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_COMPARE_MODE, GL_COMPARE_REF_TO_TEXTURE);
  }
  int width, height, scale;
  GlObject shadow, geometry, depth, occlusion, light, resolved, final, many_colors, many_depths;
  GlObject shadow_frame, geometry_frame, occlusion_frame, light_frame, many_frame, resolved_frame, final_frame;
};

Painter::Painter(Backend backend, int width, int height)
    : context_(make_context(backend, width, height)),
      gl_(load_gl(context_->loader())),
      depth_(make_program(gl_, "mesh_vertex", {"depth"})),
      geometry_(make_program(gl_, "mesh_vertex", {"geometry"})),
      occlusion_(make_program(gl_, "screen_vertex", {"occlusion"})),
      light_(make_program(gl_, "screen_vertex", {"light"})),
      background_(make_program(gl_, "screen_vertex", {"backdrop", "background"})),
      surface_(make_program(gl_, "mesh_vertex", {"backdrop", "surface"})),
      encode_(make_program(gl_, "screen_vertex", {"encode"})) {
  GLuint id = 0;
  gl_.GenVertexArrays(1, &id);
  screen_ = GlObject(gl_, id, [](const Gl& gl, GLuint old) { gl.DeleteVertexArrays(1, &old); });
}

std::vector<std::uint8_t> Painter::paint(const Subject& subject, const PictureOptions& options,
                                         const std::optional<ColorScale>& scale) {
  GLint most_samples = 0;
  gl_.GetIntegerv(GL_MAX_SAMPLES, &most_samples);
  // Where the driver has no four samples a pixel, four pixels a pixel do the same work.
  const int scale_down = options.samples > 1 && most_samples < options.samples ? 2 : 1;
  const int samples = scale_down == 1 && options.samples > 1 ? options.samples : 0;
  const Targets targets(gl_, options.width * scale_down, options.height * scale_down, samples, scale_down);

  const Frame frame = frame_of(subject);
  const Vec3 centre = frame.centre();
  Scene scene;
  scene.radius = std::max(frame.radius(), 0.01);
  const int reserved = scale ? legend_width(options.width, options.height) : 0;
  scene.camera = camera_for(options.view, subject, frame, options.width, options.height, reserved);
  scene.light = key_light(scene.camera, scene.radius);
  scene.ground_radius = kGroundReach * scene.radius;
  scene.ground_centre = {0, frame.low.y() - centre.y() - kGroundDrop, 0};
  scene.garment = upload(garment_corners(subject, options.overlay, scale, centre));
  if (subject.body) scene.body = upload(body_corners(*subject.body, centre));
  scene.ground = upload(ground_corners(Vec3::Zero(), scene.ground_centre.y(), scene.ground_radius));
  scene.color_map = make_color_map(gl_, scale);

  gl_.Enable(GL_DEPTH_TEST);
  draw_shadow_map(scene, targets);
  draw_geometry(scene, targets);
  draw_light(scene, targets);
  draw_surfaces(scene, targets, options, scale.has_value());
  std::vector<std::uint8_t> pixels = encode(targets, options.width, options.height);
  if (const GLenum error = gl_.GetError(); error != GL_NO_ERROR)
    throw std::runtime_error(error == GL_OUT_OF_MEMORY ? "OpenGL is out of memory" : "OpenGL failed");
  return pixels;
}

VertexBuffer Painter::upload(const std::vector<Corner>& corners) const {
  GLuint array = 0, buffer = 0;
  gl_.GenVertexArrays(1, &array);
  gl_.GenBuffers(1, &buffer);
  VertexBuffer mesh{{gl_, array, [](const Gl& gl, GLuint old) { gl.DeleteVertexArrays(1, &old); }},
                    {gl_, buffer, [](const Gl& gl, GLuint old) { gl.DeleteBuffers(1, &old); }},
                    static_cast<GLsizei>(corners.size())};
  gl_.BindVertexArray(array);
  gl_.BindBuffer(GL_ARRAY_BUFFER, buffer);
  gl_.BufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(corners.size() * sizeof(Corner)), corners.data(),
                 GL_STATIC_DRAW);
  const auto attribute = [&](GLuint at, GLint size, GLenum type, std::size_t offset) {
    gl_.EnableVertexAttribArray(at);
    gl_.VertexAttribPointer(at, size, type, type == GL_UNSIGNED_BYTE, sizeof(Corner),
                            reinterpret_cast<const void*>(offset));  // NOLINT(performance-no-int-to-ptr): OpenGL
  };
  attribute(0, 3, GL_FLOAT, offsetof(Corner, position));
  attribute(1, 3, GL_FLOAT, offsetof(Corner, normal));
  attribute(2, 4, GL_UNSIGNED_BYTE, offsetof(Corner, color));
  attribute(3, 1, GL_FLOAT, offsetof(Corner, scalar));
  attribute(4, 3, GL_FLOAT, offsetof(Corner, edge));
  return mesh;
}

void Painter::draw_mesh(const GlObject& program, const VertexBuffer& mesh, double inset) const {
  if (mesh.count == 0) return;
  Uniforms(gl_, program).set("u_inset", inset);
  gl_.BindVertexArray(mesh.array.id());
  gl_.DrawArrays(GL_TRIANGLES, 0, mesh.count);
}

void Painter::draw_shadow_map(const Scene& scene, const Targets& targets) const {
  gl_.BindFramebuffer(GL_FRAMEBUFFER, targets.shadow_frame.id());
  gl_.Viewport(0, 0, kShadowSize, kShadowSize);
  gl_.Clear(GL_DEPTH_BUFFER_BIT);
  gl_.Enable(GL_POLYGON_OFFSET_FILL);
  gl_.PolygonOffset(1.5f, 0);
  Uniforms(gl_, depth_).set("u_view", scene.light.view).set("u_projection", scene.light.projection);
  draw_mesh(depth_, scene.garment, 0);
  draw_mesh(depth_, scene.body, kBodyInset);
  gl_.Disable(GL_POLYGON_OFFSET_FILL);
}

void Painter::draw_geometry(const Scene& scene, const Targets& targets) const {
  gl_.BindFramebuffer(GL_FRAMEBUFFER, targets.geometry_frame.id());
  gl_.Viewport(0, 0, targets.width, targets.height);
  gl_.ClearColor(0, 0, 0, 0);
  gl_.Clear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
  Uniforms(gl_, geometry_).set("u_view", scene.camera.view).set("u_projection", scene.camera.projection);
  draw_mesh(geometry_, scene.garment, 0);
  draw_mesh(geometry_, scene.body, kBodyInset);
  draw_mesh(geometry_, scene.ground, 0);
}

void Painter::draw_light(const Scene& scene, const Targets& targets) const {
  gl_.Disable(GL_DEPTH_TEST);
  gl_.BindVertexArray(screen_.id());
  const Camera& camera = scene.camera;
  gl_.BindFramebuffer(GL_FRAMEBUFFER, targets.occlusion_frame.id());
  Uniforms(gl_, occlusion_)
      .set("u_tangent", camera.tangent_x, camera.tangent_y)
      .set("u_shift", camera.shift_x, 0)
      .set("u_size", targets.width, targets.height)
      .set("u_radius", std::min(kOcclusionRadius, kOcclusionShare * scene.radius))
      .texture("u_geometry", 0, targets.geometry);
  gl_.DrawArrays(GL_TRIANGLES, 0, 3);

  Eigen::Matrix4f to_texture = Eigen::Matrix4f::Identity();
  to_texture.topLeftCorner<3, 3>() *= 0.5f;
  to_texture.topRightCorner<3, 1>().setConstant(0.5f);
  const Eigen::Matrix4f to_light = to_texture * scene.light.projection * scene.light.view * camera.view.inverse();
  const Vec3 key(scene.light.towards.dot(camera.right), scene.light.towards.dot(camera.up),
                 scene.light.towards.dot(camera.back));
  gl_.BindFramebuffer(GL_FRAMEBUFFER, targets.light_frame.id());
  Uniforms(gl_, light_)
      .set("u_tangent", camera.tangent_x, camera.tangent_y)
      .set("u_shift", camera.shift_x, 0)
      .set("u_size", targets.width, targets.height)
      .set("u_key", key)
      .set("u_light", to_light)
      .set("u_shadow_texel", 2 * 1.02 * scene.radius / kShadowSize)
      .texture("u_geometry", 0, targets.geometry)
      .texture("u_occlusion", 1, targets.occlusion)
      .texture("u_shadow", 2, targets.shadow);
  gl_.DrawArrays(GL_TRIANGLES, 0, 3);
  gl_.Enable(GL_DEPTH_TEST);
}

void Painter::draw_surfaces(const Scene& scene, const Targets& targets, const PictureOptions& options,
                            bool mapped) const {
  gl_.BindFramebuffer(GL_FRAMEBUFFER, targets.many_frame.id());
  gl_.Clear(GL_DEPTH_BUFFER_BIT);
  gl_.Disable(GL_DEPTH_TEST);
  Uniforms(gl_, background_).set("u_size", targets.width, targets.height);
  gl_.BindVertexArray(screen_.id());
  gl_.DrawArrays(GL_TRIANGLES, 0, 3);
  gl_.Enable(GL_DEPTH_TEST);

  const bool wire = options.overlay == Overlay::wireframe;
  const Camera& camera = scene.camera;
  const Uniforms surface(gl_, surface_);
  surface.set("u_view", camera.view)
      .set("u_projection", camera.projection)
      .set("u_size", targets.width, targets.height)
      .set("u_eye", camera.eye)
      .set("u_key", scene.light.towards)
      .set("u_fill", scene.light.fill)
      .set("u_up", Vec3((0.85 * Vec3::UnitY() + 0.15 * camera.up).normalized()))
      .set("u_ground_centre", scene.ground_centre)
      .set("u_ground_radius", scene.ground_radius)
      .set("u_line_width", wire ? kWireHalfWidth : kSeamHalfWidth)
      .set("u_line_pixels", wire ? kWireHalfPixels : kSeamHalfPixels)
      .set("u_line_strength", wire ? kWireStrength : kSeamStrength)
      .set("u_rim_strength", wire ? 0.0 : kSeamRim)
      .texture("u_light", 0, targets.light)
      .texture("u_color_map", 1, scene.color_map);
  surface.set("u_material", 0).set("u_paint", mapped ? 1 : 0);
  draw_mesh(surface_, scene.garment, 0);
  surface.set("u_material", 1).set("u_paint", 0);
  draw_mesh(surface_, scene.body, kBodyInset);
  surface.set("u_material", 2);
  draw_mesh(surface_, scene.ground, 0);
}

std::vector<std::uint8_t> Painter::encode(const Targets& targets, int width, int height) const {
  gl_.BindFramebuffer(GL_READ_FRAMEBUFFER, targets.many_frame.id());
  gl_.BindFramebuffer(GL_DRAW_FRAMEBUFFER, targets.resolved_frame.id());
  gl_.BlitFramebuffer(0, 0, targets.width, targets.height, 0, 0, targets.width, targets.height, GL_COLOR_BUFFER_BIT,
                      GL_NEAREST);
  gl_.BindFramebuffer(GL_FRAMEBUFFER, targets.final_frame.id());
  gl_.Viewport(0, 0, width, height);
  gl_.Disable(GL_DEPTH_TEST);
  gl_.BindVertexArray(screen_.id());
  Uniforms(gl_, encode_).set("u_scale", targets.scale).texture("u_linear", 0, targets.resolved);
  gl_.DrawArrays(GL_TRIANGLES, 0, 3);
  gl_.PixelStorei(GL_PACK_ALIGNMENT, 1);
  const std::size_t row = std::size_t(3) * width;
  std::vector<std::uint8_t> bottom_up(row * height), pixels(row * height);
  gl_.ReadPixels(0, 0, width, height, GL_RGB, GL_UNSIGNED_BYTE, bottom_up.data());
  for (int y = 0; y < height; ++y)
    std::copy_n(bottom_up.begin() + row * (height - 1 - y), row, pixels.begin() + row * y);
  return pixels;
}

}  // namespace toile
