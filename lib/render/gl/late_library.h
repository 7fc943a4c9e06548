// A shared library that is loaded when it is first needed, and never unloaded.
#pragma once

#include <dlfcn.h>

#include <string>
#include <type_traits>

namespace goniochrome::render {

class LateLibrary {
 public:
  explicit LateLibrary(const char* name) : handle_(dlopen(name, RTLD_NOW | RTLD_LOCAL)) {
    if (handle_ != nullptr) return;
    complete_ = false;
    if (const char* why = dlerror()) reason_ = std::string(" (") + why + ")";
  }

  // Sets the pointer to the function of that name, or to null.
  template <typename Function>
  void find(Function& function, const char* name) {
    function = handle_ != nullptr ? reinterpret_cast<Function>(dlsym(handle_, name)) : nullptr;
    complete_ = complete_ && function != nullptr;
  }

  // True if the library was loaded and had every function that was asked for.
  bool complete() const { return complete_; }
  // Why it could not be loaded, in parentheses after a space; "" where it was loaded.
  const std::string& reason() const { return reason_; }

 private:
  void* handle_;
  bool complete_ = true;
  std::string reason_;
};

}  // namespace goniochrome::render
