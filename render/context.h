#pragma once
// An off-screen OpenGL 3.3 core context, behind one interface because OSMesa leaves Mesa in 25.1: both ways of making
// one are built and tested. The libraries are opened when a context is made, so a process that draws nothing (the
// server) never loads Mesa and LLVM.

#include <memory>
#include <string_view>

namespace toile {

/// `automatic` is OSMesa, or EGL where OSMesa is missing or fails.
enum class Backend { automatic, osmesa, egl };

/// Finds an OpenGL function by name, or gives nullptr.
using GlFunction = void (*)();
using GlLoader = GlFunction (*)(const char* name);

/// Current on the thread that made it until destroyed; to be used and destroyed on that thread only. Several threads
/// may each hold one. What is drawn goes to framebuffer objects: the default framebuffer is not to be relied on.
class Context {
 public:
  virtual ~Context() = default;
  virtual GlLoader loader() const = 0;
  virtual std::string_view name() const = 0;  ///< "osmesa" or "egl"

 protected:
  Context() = default;
  Context(const Context&) = delete;
  Context& operator=(const Context&) = delete;
};

/// Width and height [px] of the default framebuffer, both at least 1. Throws std::runtime_error that says why when no
/// context can be had.
std::unique_ptr<Context> make_context(Backend backend, int width, int height);

/// The two implementations that make_context() chooses from; same contract.
std::unique_ptr<Context> make_osmesa_context(int width, int height);
std::unique_ptr<Context> make_egl_context(int width, int height);

}  // namespace toile
