// SPDX-License-Identifier: GPL-3.0-or-later
#include "device/projector/private/sdl_library.hpp"

#include "base/shared_library.hpp"

namespace vam::device::sdl {

namespace {

SdlApi load() {
  const SharedLibrary library("sdl", "libSDL2-2.0.so.0", "libsdl2-2.0-0");
  SdlApi found{};
#define VAM_FIND(name) library.find(found.name, #name);
  VAM_SDL_FUNCTIONS(VAM_FIND)
#undef VAM_FIND
  return found;
}

}  // namespace

const SdlApi& api() {
  static const SdlApi loaded = load();
  return loaded;
}

}  // namespace vam::device::sdl
