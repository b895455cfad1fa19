#include "base/shared_library.hpp"

#include <dlfcn.h>

#include "base/error.hpp"

namespace vam {

SharedLibrary::SharedLibrary(const std::string& purpose, const std::string& name, const std::string& package)
    : purpose_(purpose), name_(name), handle_(dlopen(name.c_str(), RTLD_NOW | RTLD_LOCAL)) {
  if (handle_ == nullptr) {
    throw Error{Fault::absent, purpose_ + ": " + name_ + " cannot be loaded; install the package " + package};
  }
}

void* SharedLibrary::address(const char* symbol) const {
  void* found = dlsym(handle_, symbol);
  if (found == nullptr) {
    throw Error{Fault::absent, purpose_ + ": " + name_ + " has no function " + symbol + "; install another release"};
  }
  return found;
}

}  // namespace vam
