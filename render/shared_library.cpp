#include "render/shared_library.h"

#include <dlfcn.h>

#include <stdexcept>

namespace toile {

SharedLibrary::SharedLibrary(const char* file_name)
    : file_name_(file_name), handle_(dlopen(file_name, RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE)) {
  if (!handle_) throw std::runtime_error(file_name_ + " can't be loaded");
}

void* SharedLibrary::address(const char* name) const {
  void* found = dlsym(handle_, name);
  if (!found) throw std::runtime_error(file_name_ + " has no " + name);
  return found;
}

}  // namespace toile
