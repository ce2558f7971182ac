#include "render/context.h"

#include <stdexcept>
#include <string>

namespace toile {

std::unique_ptr<Context> make_context(Backend backend, int width, int height) {
  if (backend == Backend::osmesa) return make_osmesa_context(width, height);
  if (backend == Backend::egl) return make_egl_context(width, height);
  std::string reason;
  try {
    return make_osmesa_context(width, height);
  } catch (const std::runtime_error& error) {
    reason = error.what();
  }
  try {
    return make_egl_context(width, height);
  } catch (const std::runtime_error& error) {
    throw std::runtime_error("no off-screen OpenGL: " + reason + "; " + error.what());
  }
}

}  // namespace toile
