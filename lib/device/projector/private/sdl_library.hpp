// SPDX-License-Identifier: GPL-3.0-or-later
// SDL, loaded when the screens of a desktop are queried: with X11, Wayland and sound it is 40 libraries. Nothing is
// linked. SDL.h is included here, and by the two sources that call it through this table: the types of the pointers are
// taken from its declarations, so that the compiler checks them, and its structures and constants are used in the
// calls.
#pragma once

#include <SDL.h>

// Every function of SDL that is called.
// clang-format off
#define VAM_SDL_FUNCTIONS(X)                                                                                  \
  X(SDL_CreateRenderer) X(SDL_CreateTexture) X(SDL_CreateWindow) X(SDL_DestroyRenderer) X(SDL_DestroyTexture) \
  X(SDL_DestroyWindow) X(SDL_DisableScreenSaver) X(SDL_GetCurrentDisplayMode) X(SDL_GetDisplayBounds)         \
  X(SDL_GetDisplayName) X(SDL_GetError) X(SDL_GetNumVideoDisplays) X(SDL_Init) X(SDL_LockTexture)             \
  X(SDL_PollEvent) X(SDL_Quit) X(SDL_RenderClear) X(SDL_RenderCopy) X(SDL_RenderPresent) X(SDL_SetHint)       \
  X(SDL_SetRenderDrawColor) X(SDL_ShowCursor) X(SDL_UnlockTexture)
// clang-format on

namespace vam::device::sdl {

struct SdlApi {
#define VAM_POINTER(name) decltype(&::name) name;  // NOLINT(bugprone-macro-parentheses): it is declared here
  VAM_SDL_FUNCTIONS(VAM_POINTER)
#undef VAM_POINTER
};

/// Throws Fault::absent when the machine does not have it.
const SdlApi& api();

}  // namespace vam::device::sdl
