#include "render/gl_objects.h"

#include <stdexcept>
#include <string>

#include "render/shader_sources.h"

namespace toile {
namespace {

void check_framebuffer(const Gl& gl) {
  if (gl.CheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
    throw std::runtime_error("OpenGL refuses a framebuffer (out of memory?)");
}

GlObject new_framebuffer(const Gl& gl) {
  GLuint id = 0;
  gl.GenFramebuffers(1, &id);
  gl.BindFramebuffer(GL_FRAMEBUFFER, id);
  return {gl, id, [](const Gl& g, GLuint old) { g.DeleteFramebuffers(1, &old); }};
}

GlObject compile(const Gl& gl, GLenum stage, const std::vector<std::string_view>& names) {
  std::string text = "#version 330 core\n";
  for (const std::string_view name : names) text += shader_source(name);
  GlObject shader(gl, gl.CreateShader(stage), [](const Gl& g, GLuint old) { g.DeleteShader(old); });
  const char* start = text.c_str();
  gl.ShaderSource(shader.id(), 1, &start, nullptr);
  gl.CompileShader(shader.id());
  GLint good = 0;
  gl.GetShaderiv(shader.id(), GL_COMPILE_STATUS, &good);
  if (!good) {
    std::string log(4096, '\0');
    GLsizei length = 0;
    gl.GetShaderInfoLog(shader.id(), static_cast<GLsizei>(log.size()), &length, log.data());
    throw std::runtime_error("shader " + std::string(names.back()) + ": " + log.substr(0, length));
  }
  return shader;
}

}  // namespace

GlObject make_texture(const Gl& gl, PixelFormat pixels, int width, int height, GLint filter, const void* data) {
  GLuint id = 0;
  gl.GenTextures(1, &id);
  GlObject texture(gl, id, [](const Gl& g, GLuint old) { g.DeleteTextures(1, &old); });
  gl.BindTexture(GL_TEXTURE_2D, id);
  gl.TexImage2D(GL_TEXTURE_2D, 0, pixels.internal, width, height, 0, pixels.format, pixels.type, data);
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, filter);
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, filter);
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  return texture;
}

GlObject make_renderbuffer(const Gl& gl, GLenum internal, int samples, int width, int height) {
  GLuint id = 0;
  gl.GenRenderbuffers(1, &id);
  GlObject buffer(gl, id, [](const Gl& g, GLuint old) { g.DeleteRenderbuffers(1, &old); });
  gl.BindRenderbuffer(GL_RENDERBUFFER, id);
  gl.RenderbufferStorageMultisample(GL_RENDERBUFFER, samples, internal, width, height);
  return buffer;
}

GlObject make_framebuffer(const Gl& gl, const GlObject* color, const GlObject* depth) {
  GlObject framebuffer = new_framebuffer(gl);
  if (color) gl.FramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, color->id(), 0);
  if (depth) gl.FramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, depth->id(), 0);
  if (!color) {
    gl.DrawBuffer(GL_NONE);
    gl.ReadBuffer(GL_NONE);
  }
  check_framebuffer(gl);
  return framebuffer;
}

GlObject make_multisampled_framebuffer(const Gl& gl, const GlObject& color, const GlObject& depth) {
  GlObject framebuffer = new_framebuffer(gl);
  gl.FramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, color.id());
  gl.FramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, depth.id());
  check_framebuffer(gl);
  return framebuffer;
}

GlObject make_program(const Gl& gl, std::string_view vertex, const std::vector<std::string_view>& fragment) {
  const GlObject vertex_shader = compile(gl, GL_VERTEX_SHADER, {vertex});
  const GlObject fragment_shader = compile(gl, GL_FRAGMENT_SHADER, fragment);
  GlObject program(gl, gl.CreateProgram(), [](const Gl& g, GLuint old) { g.DeleteProgram(old); });
  gl.AttachShader(program.id(), vertex_shader.id());
  gl.AttachShader(program.id(), fragment_shader.id());
  gl.LinkProgram(program.id());
  GLint good = 0;
  gl.GetProgramiv(program.id(), GL_LINK_STATUS, &good);
  if (!good) {
    std::string log(4096, '\0');
    GLsizei length = 0;
    gl.GetProgramInfoLog(program.id(), static_cast<GLsizei>(log.size()), &length, log.data());
    throw std::runtime_error("shader " + std::string(fragment.back()) + " does not link: " + log.substr(0, length));
  }
  return program;
}

}  // namespace toile
