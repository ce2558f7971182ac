#pragma once
// A shared library opened at run time and never closed: Mesa keeps state (threads, LLVM) that must not be unmapped.

#include <string>

namespace toile {

class SharedLibrary {
 public:
  /// Throws std::runtime_error when no library of this name (as for dlopen) can be loaded.
  explicit SharedLibrary(const char* file_name);

  /// The function of type Signature* by its name; throws std::runtime_error when it is missing.
  template <typename Signature>
  Signature* function(const char* name) const {
    return reinterpret_cast<Signature*>(address(name));
  }

 private:
  void* address(const char* name) const;

  std::string file_name_;
  void* handle_;
};

}  // namespace toile
