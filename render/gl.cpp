#include "render/gl.h"

#include <stdexcept>

namespace toile {

Gl load_gl(GlLoader loader) {
  Gl gl;
#define TOILE_GL_LOAD(type, name)                       \
  gl.name = reinterpret_cast<type>(loader("gl" #name)); \
  if (!gl.name) throw std::runtime_error("OpenGL has no gl" #name);
  TOILE_GL_FUNCTIONS(TOILE_GL_LOAD)
#undef TOILE_GL_LOAD
  return gl;
}

}  // namespace toile
