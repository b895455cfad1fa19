// SPDX-License-Identifier: GPL-3.0-or-later
#include <fcntl.h>
#include <unistd.h>
#include <xf86drm.h>

#include <cmath>
#include <cstdlib>
#include <string>

#include "base/error.hpp"
#include "base/text/text.hpp"
#include "device/projector/display_backends.hpp"
#include "device/projector/private/drm_output.hpp"
#include "device/projector/private/sdl_library.hpp"

namespace vam::device {

namespace {

std::string size_text(int columns, int rows, double hz) {
  return std::to_string(columns) + " x " + std::to_string(rows) + " at " + format_number(hz, 4) + " Hz";
}

// Only the master of a card sets what its screens show; whoever asks first is it, and gives it back here.
std::string card_obstacle(int card) {
  if (drmSetMaster(card) == 0) {
    drmDropMaster(card);
    return "";
  }
  return "another program is master of the graphics card, as a desktop is; log out of it, or use sdl:";
}

void add_drm(std::vector<DeviceListing>& found) {
  for (const std::string& path : drm_cards()) {
    const int card = open(path.c_str(), O_RDWR | O_CLOEXEC);
    if (card < 0) {
      found.push_back({"display", "drm:", path, node_obstacle(path)});
      continue;
    }
    const std::string obstacle = card_obstacle(card);
    for (const DrmScreen& screen : drm_screens(card)) {
      found.push_back(
          {"display", "drm:" + screen.connector, size_text(screen.columns, screen.rows, screen.hz), obstacle});
    }
    close(card);
  }
}

// Without a desktop SDL would count an invisible screen.
void add_sdl(std::vector<DeviceListing>& found) {
  if (std::getenv("DISPLAY") == nullptr && std::getenv("WAYLAND_DISPLAY") == nullptr) return;
  sdl::api().SDL_SetHint(SDL_HINT_NO_SIGNAL_HANDLERS, "1");
  if (sdl::api().SDL_Init(SDL_INIT_VIDEO) != 0) {
    found.push_back({"display", "sdl:0", "",
                     std::string("the desktop cannot be reached (") + sdl::api().SDL_GetError() + "); check DISPLAY"});
    return;
  }
  for (int n = 0; n < sdl::api().SDL_GetNumVideoDisplays(); ++n) {
    SDL_DisplayMode mode{};
    if (sdl::api().SDL_GetCurrentDisplayMode(n, &mode) != 0) continue;
    const char* name = sdl::api().SDL_GetDisplayName(n);
    found.push_back({"display", "sdl:" + std::to_string(n),
                     size_text(mode.w, mode.h, mode.refresh_rate > 0 ? mode.refresh_rate : 60) +
                         (name != nullptr ? std::string(", ") + name : ""),
                     ""});
  }
  sdl::api().SDL_Quit();
}

}  // namespace

std::vector<DeviceListing> find_displays() {
  std::vector<DeviceListing> found;
  add_drm(found);
  try {
    add_sdl(found);
  } catch (const Error& missing) {
    found.push_back({"display", "sdl:0", "", missing.what()});
  }
  return found;
}

}  // namespace vam::device
