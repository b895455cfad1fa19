// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/shared_library.hpp"

#include <dlfcn.h>

#include <cerrno>
#include <cstring>

#include "base/error.hpp"
#include "base/system_error.hpp"

namespace vam {

SharedLibrary::SharedLibrary(const std::string& purpose, const std::string& name, const std::string& package)
    : purpose_(purpose), name_(name), handle_(dlopen(name.c_str(), RTLD_NOW | RTLD_LOCAL)) {
  if (handle_ == nullptr) {
    const std::string why = dlerror();
    // As the loader says it where an address space is bounded, or all memory is taken.
    for (const char* refused : {"Cannot allocate memory", "failed to map segment", "out of memory"}) {
      if (why.find(refused) == std::string::npos) continue;
      throw Error{Fault::memory, purpose_ + ": no memory is left to load " + name_ +
                                     "; allow more (ulimit -v), or close other programs"};
    }
    for (const int lack : {EMFILE, ENFILE}) {
      if (why.find(std::strerror(lack)) == std::string::npos) continue;
      throw system_error(Fault::memory, purpose_ + ": " + name_ + " cannot be loaded", lack);
    }
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
