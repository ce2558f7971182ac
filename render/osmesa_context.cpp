#include <GL/osmesa.h>

#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <vector>

#include "render/context.h"
#include "render/shared_library.h"

namespace toile {
namespace {

class OsmesaContext final : public Context {
 public:
  OsmesaContext(int width, int height) : library_("libOSMesa.so.8"), pixels_(std::size_t(4) * width * height) {
    const int attributes[] = {OSMESA_FORMAT,
                              OSMESA_RGBA,
                              OSMESA_PROFILE,
                              OSMESA_CORE_PROFILE,
                              OSMESA_CONTEXT_MAJOR_VERSION,
                              3,
                              OSMESA_CONTEXT_MINOR_VERSION,
                              3,
                              0};
    context_ =
        library_.function<decltype(OSMesaCreateContextAttribs)>("OSMesaCreateContextAttribs")(attributes, nullptr);
    if (!context_) throw std::runtime_error("OSMesa makes no OpenGL 3.3 core context");
    if (!make_current_(context_, pixels_.data(), GL_UNSIGNED_BYTE, width, height)) {
      destroy_(context_);
      throw std::runtime_error("OSMesa does not make its context current");
    }
  }
  ~OsmesaContext() override {
    make_current_(nullptr, nullptr, GL_UNSIGNED_BYTE, 0, 0);
    destroy_(context_);
  }
  GlLoader loader() const override { return get_proc_address_; }
  std::string_view name() const override { return "osmesa"; }

 private:
  SharedLibrary library_;
  decltype(&OSMesaMakeCurrent) make_current_ = library_.function<decltype(OSMesaMakeCurrent)>("OSMesaMakeCurrent");
  decltype(&OSMesaDestroyContext) destroy_ = library_.function<decltype(OSMesaDestroyContext)>("OSMesaDestroyContext");
  GlLoader get_proc_address_ = library_.function<GlFunction(const char*)>("OSMesaGetProcAddress");
  std::vector<std::uint8_t> pixels_;
  OSMesaContext context_ = nullptr;
};

}  // namespace

std::unique_ptr<Context> make_osmesa_context(int width, int height) {
  return std::make_unique<OsmesaContext>(width, height);
}

}  // namespace toile
