// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <utility>

#include "base/error.hpp"
#include "base/index.hpp"
#include "base/text/json.hpp"
#include "device/projector/display_backends.hpp"
#include "device/projector/private/sdl_library.hpp"
#include "device/safety/stop_order.hpp"

namespace vam::device {

namespace {

Error refused(const std::string& doing) {
  return {Fault::absent, "sdl: cannot " + doing + " (" + sdl::api().SDL_GetError() + ")"};
}

struct WindowCloser {
  void operator()(SDL_Window* window) const { sdl::api().SDL_DestroyWindow(window); }
};
struct RendererCloser {
  void operator()(SDL_Renderer* renderer) const { sdl::api().SDL_DestroyRenderer(renderer); }
};
struct TextureCloser {
  void operator()(SDL_Texture* texture) const { sdl::api().SDL_DestroyTexture(texture); }
};
struct Library {
  Library() {
    // Without a desktop SDL would draw on an invisible screen.
    if (std::getenv("DISPLAY") == nullptr && std::getenv("WAYLAND_DISPLAY") == nullptr) {
      throw Error{Fault::absent, "sdl: cannot reach a desktop; set DISPLAY or WAYLAND_DISPLAY, or use drm:"};
    }
    // A program that is killed ends with its last thread, and its window only then: Mesa's for the cache goes behind
    // all others (SCHED_BATCH, nice 19), on a busy machine by seconds.
    setenv("MESA_SHADER_CACHE_DISABLE", "true", 1);
    sdl::api().SDL_SetHint(SDL_HINT_NO_SIGNAL_HANDLERS, "1");            // signals are ours
    sdl::api().SDL_SetHint(SDL_HINT_VIDEO_MINIMIZE_ON_FOCUS_LOSS, "0");  // a print must not vanish at a click elsewhere
    if (sdl::api().SDL_Init(SDL_INIT_VIDEO) != 0) throw refused("reach a desktop; set DISPLAY or WAYLAND_DISPLAY");
    sdl::api().SDL_ShowCursor(SDL_DISABLE);  // before there is a window: a cursor is light, too
  }
  ~Library() { sdl::api().SDL_Quit(); }
  Library(const Library&) = delete;
  Library& operator=(const Library&) = delete;
};

class SdlDisplay final : public Display {
 public:
  SdlDisplay(int screen, Clock& clock, Guardian* guardian) : clock_(clock), order_(guardian) {
    SDL_Rect bounds{};
    if (sdl::api().SDL_GetDisplayBounds(screen, &bounds) != 0) {
      throw Error{Fault::absent, "sdl:" + std::to_string(screen) + ": no such screen; number of screens: " +
                                     std::to_string(sdl::api().SDL_GetNumVideoDisplays())};
    }
    SDL_DisplayMode current{};
    sdl::api().SDL_GetCurrentDisplayMode(screen, &current);
    mode_ = {bounds.w, bounds.h, current.refresh_rate > 0 ? static_cast<double>(current.refresh_rate) : 60.0};
    window_.reset(
        sdl::api().SDL_CreateWindow("vam-project", bounds.x, bounds.y, bounds.w, bounds.h,
                                    SDL_WINDOW_BORDERLESS | SDL_WINDOW_FULLSCREEN_DESKTOP | SDL_WINDOW_ALWAYS_ON_TOP));
    if (!window_) throw refused("open a window");
    renderer_.reset(sdl::api().SDL_CreateRenderer(window_.get(), -1, SDL_RENDERER_PRESENTVSYNC));
    if (!renderer_) throw refused("draw");
    texture_.reset(sdl::api().SDL_CreateTexture(renderer_.get(), SDL_PIXELFORMAT_ARGB8888, SDL_TEXTUREACCESS_STREAMING,
                                                mode_.columns, mode_.rows));
    if (!texture_) throw refused("draw");
    sdl::api().SDL_DisableScreenSaver();
    origin_s_ = clock_.now_s();
    next_s_ = origin_s_;
    present(-1);
    present(-1);
  }

  ~SdlDisplay() override {
    try {
      present(-1);
    } catch (...) {
      // The window goes next, and its image with it.
    }
  }

  DisplayMode mode() const override { return mode_; }

  int add(const GreyImage& levels) override {
    frames_.push_back(screen_bytes(levels, mode_));
    return count_of(frames_) - 1;
  }

  void exchange(ScreenFrames& frames) override { frames_.swap(frames); }

  Flip present(int index) override {
    draw(index);
    watch(index >= 0);
    answer_events();
    sdl::api().SDL_RenderPresent(renderer_.get());
    pace();
    if (index < 0) order_.withdraw();
    const double now_s = clock_.now_s();
    const long sequence = std::lround((now_s - origin_s_) * mode_.hz);
    next_s_ =
        origin_s_ + static_cast<double>(sequence) / mode_.hz;  // however late: the next one has a blank of its own
    return {sequence, now_s};
  }

 private:
  void draw(int index) {
    sdl::api().SDL_SetRenderDrawColor(renderer_.get(), 0, 0, 0, 255);
    sdl::api().SDL_RenderClear(renderer_.get());
    if (index < 0) return;
    void* pixels = nullptr;
    int pitch = 0;
    if (sdl::api().SDL_LockTexture(texture_.get(), nullptr, &pixels, &pitch) != 0) throw refused("draw");
    const auto& bytes = frames_[index];
    for (int y = 0; y < mode_.rows; ++y) {
      auto* row = reinterpret_cast<std::uint32_t*>(static_cast<char*>(pixels) + static_cast<std::ptrdiff_t>(y) * pitch);
      const auto* from = bytes.data() + static_cast<std::ptrdiff_t>(y) * mode_.columns;
      for (int x = 0; x < mode_.columns; ++x) row[x] = 0xFF000000U | from[x] * 0x010101U;
    }
    sdl::api().SDL_UnlockTexture(texture_.get());
    sdl::api().SDL_RenderCopy(renderer_.get(), texture_.get(), nullptr, nullptr);
  }

  // A screen without a vertical blank (a virtual one, or a driver that ignores the wish) returns at once: then the
  // clock sets the pace.
  void pace() {
    next_s_ += 1 / mode_.hz;
    const double now_s = clock_.now_s();
    if (now_s > next_s_ + 0.5 / mode_.hz) {  // late: the next blank after now
      next_s_ = origin_s_ + std::ceil((now_s - origin_s_) * mode_.hz) / mode_.hz;
    }
    if (now_s < next_s_ - 0.25 / mode_.hz) clock_.sleep_until(next_s_);
  }

  static void answer_events() {
    SDL_Event event{};
    while (sdl::api().SDL_PollEvent(&event) != 0) {
      const bool escape = event.type == SDL_KEYDOWN && event.key.keysym.sym == SDLK_ESCAPE;
      if (escape || event.type == SDL_QUIT) std::raise(SIGINT);
    }
  }

  // While an image is on, a tool that hangs must be killed: its window goes with it.
  void watch(bool lit) {
    if (lit) order_.give({{"do", "nothing"}, {"order", 0}, {"name", "window"}});
    order_.beat();
  }

  Library library_;
  Clock& clock_;
  StopOrder order_;
  DisplayMode mode_;
  std::unique_ptr<SDL_Window, WindowCloser> window_;
  std::unique_ptr<SDL_Renderer, RendererCloser> renderer_;
  std::unique_ptr<SDL_Texture, TextureCloser> texture_;
  ScreenFrames frames_;
  double origin_s_ = 0;
  double next_s_ = 0;
};

}  // namespace

std::unique_ptr<Display> open_sdl_display(const Address& address, const DisplayMode&, Clock& clock,
                                          Guardian* guardian) {
  int screen = 0;
  try {
    if (!address.place.empty()) screen = std::stoi(address.place);
  } catch (const std::exception&) {
    throw Error{Fault::usage, "device '" + address.text + "': '" + address.place + "' is not a screen number"};
  }
  const char* desktop = std::getenv("DISPLAY");
  auto lock = std::make_unique<DeviceLock>(std::string(sdl_lock) + (desktop != nullptr ? desktop : "") + "-" +
                                           std::to_string(screen));
  if (guardian != nullptr) guardian->keep(lock->handle());
  auto display = std::make_unique<SdlDisplay>(screen, clock, guardian);
  display->hold(std::move(lock));
  return display;
}

}  // namespace vam::device
