#define EGL_NO_X11
#include <EGL/egl.h>
#include <EGL/eglext.h>

#include <stdexcept>

#include "render/context.h"
#include "render/shared_library.h"

namespace toile {
namespace {

class EglContext final : public Context {
 public:
  EglContext() : library_("libEGL.so.1") {
    const auto get_display = library_.function<decltype(eglGetPlatformDisplay)>("eglGetPlatformDisplay");
    const auto initialize = library_.function<decltype(eglInitialize)>("eglInitialize");
    const auto bind_api = library_.function<decltype(eglBindAPI)>("eglBindAPI");
    const auto create = library_.function<decltype(eglCreateContext)>("eglCreateContext");
    // The display is one per process and not counted by EGL, so it is never terminated: another thread may draw on it.
    display_ = get_display(EGL_PLATFORM_SURFACELESS_MESA, reinterpret_cast<void*>(EGL_DEFAULT_DISPLAY), nullptr);
    if (display_ == EGL_NO_DISPLAY || !initialize(display_, nullptr, nullptr))
      throw std::runtime_error("EGL has no surfaceless display");
    if (!bind_api(EGL_OPENGL_API)) throw std::runtime_error("EGL has no desktop OpenGL");
    const EGLint attributes[] = {
        EGL_CONTEXT_MAJOR_VERSION,           3,       EGL_CONTEXT_MINOR_VERSION, 3, EGL_CONTEXT_OPENGL_PROFILE_MASK,
        EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT, EGL_NONE};
    context_ = create(display_, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, attributes);
    if (context_ == EGL_NO_CONTEXT) throw std::runtime_error("EGL makes no OpenGL 3.3 core context");
    if (!make_current_(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_)) {
      destroy_(display_, context_);
      throw std::runtime_error("EGL does not make its context current without a surface");
    }
  }
  ~EglContext() override {
    make_current_(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    destroy_(display_, context_);
  }
  GlLoader loader() const override { return get_proc_address_; }
  std::string_view name() const override { return "egl"; }

 private:
  SharedLibrary library_;
  decltype(&eglMakeCurrent) make_current_ = library_.function<decltype(eglMakeCurrent)>("eglMakeCurrent");
  decltype(&eglDestroyContext) destroy_ = library_.function<decltype(eglDestroyContext)>("eglDestroyContext");
  GlLoader get_proc_address_ = library_.function<GlFunction(const char*)>("eglGetProcAddress");
  EGLDisplay display_ = EGL_NO_DISPLAY;
  EGLContext context_ = EGL_NO_CONTEXT;
};

}  // namespace

// Surfaceless: there is no default framebuffer to give a size to.
std::unique_ptr<Context> make_egl_context(int, int) { return std::make_unique<EglContext>(); }

}  // namespace toile
