#pragma once
// OpenGL objects that free themselves, and the few ways in which this folder makes them. All of them must die before
// the context that they were made in.

#include <cstddef>
#include <string_view>
#include <utility>
#include <vector>

#include "render/gl.h"

namespace toile {

class GlObject {
 public:
  using Remove = void (*)(const Gl&, GLuint);
  GlObject() = default;
  GlObject(const Gl& gl, GLuint id, Remove remove) : gl_(&gl), id_(id), remove_(remove) {}
  GlObject(GlObject&& other) noexcept { *this = std::move(other); }
  GlObject& operator=(GlObject&& other) noexcept {
    std::swap(gl_, other.gl_);
    std::swap(id_, other.id_);
    std::swap(remove_, other.remove_);
    return *this;
  }
  ~GlObject() {
    if (id_) remove_(*gl_, id_);
  }
  GLuint id() const { return id_; }

 private:
  const Gl* gl_ = nullptr;
  GLuint id_ = 0;
  Remove remove_ = nullptr;
};

/// How a texture stores a pixel; `format` and `type` are those of the upload.
struct PixelFormat {
  GLint internal;
  GLenum format, type;
};

/// A texture without mipmaps, clamped at its borders; `data` may be null.
GlObject make_texture(const Gl& gl, PixelFormat pixels, int width, int height, GLint filter, const void* data);

/// A multisampled renderbuffer.
GlObject make_renderbuffer(const Gl& gl, GLenum internal, int samples, int width, int height);

/// A framebuffer of textures (0: none), checked. It is left bound.
GlObject make_framebuffer(const Gl& gl, const GlObject* color, const GlObject* depth);

/// A framebuffer of renderbuffers, checked. It is left bound.
GlObject make_multisampled_framebuffer(const Gl& gl, const GlObject& color, const GlObject& depth);

/// Triangle corners in a buffer of their own.
struct VertexBuffer {
  GlObject array, buffer;
  GLsizei count = 0;
};

/// Compiles and links; the shaders' texts are taken from shader_source() by name and joined. Throws std::runtime_error
/// with the compiler's log.
GlObject make_program(const Gl& gl, std::string_view vertex, const std::vector<std::string_view>& fragment);

}  // namespace toile
