// SPDX-License-Identifier: GPL-3.0-or-later
// A shared library that is loaded when it is first needed, so that programs which may never need it start without it.
#pragma once

#include <string>

namespace vam {

class SharedLibrary {
 public:
  /// By its name and ABI version (libX.so.N); it stays to the end of the process. `purpose` is the subject of errors,
  /// `package` what to install. Throws Fault::absent when it cannot be loaded,
  /// Fault::memory when there is no room for it.
  SharedLibrary(const std::string& purpose, const std::string& name, const std::string& package);

  /// Sets a pointer to the function of that name. Throws Fault::absent when there is none.
  template <class Function>
  void find(Function*& function, const char* symbol) const {
    function = reinterpret_cast<Function*>(address(symbol));
  }

 private:
  [[nodiscard]] void* address(const char* symbol) const;

  std::string purpose_;
  std::string name_;
  void* handle_;
};

}  // namespace vam
