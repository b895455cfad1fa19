// SPDX-License-Identifier: GPL-3.0-or-later
#include <poll.h>
#include <unistd.h>
#include <xf86drm.h>
#include <xf86drmMode.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <memory>
#include <utility>

#include "base/error.hpp"
#include "base/index.hpp"
#include "base/text/json.hpp"
#include "device/os/interrupt.hpp"
#include "device/projector/display_backends.hpp"
#include "device/projector/private/drm_buffer.hpp"
#include "device/projector/private/drm_output.hpp"
#include "device/safety/stop_order.hpp"

namespace vam::device {

namespace {

constexpr double flip_timeout_s = 0.25;  // less than the guardian's patience
constexpr double unplugged_s = 0.2;      // so often the cable is looked at

std::string reason() { return std::string(" (") + std::strerror(errno) + ")"; }

// Whose fault it is that the card refuses, once it had been ours.
Fault fault_of_card() {
  if (errno == ENODEV || errno == ENXIO) return Fault::absent;                  // unplugged
  if (errno == EBUSY || errno == EACCES || errno == EPERM) return Fault::busy;  // a flip hangs, or another is master
  return Fault::io;
}

class DrmDisplay final : public Display {
 public:
  DrmDisplay(const std::string& connector, const std::string& mode, std::optional<int> bits, Clock& clock,
             Guardian* guardian)
      : clock_(clock), order_(guardian), output_(open_drm_output(connector, mode)), name_("drm:" + connector) {
    if (drmSetMaster(output_.card) != 0) {
      const std::string why = reason();
      close(output_.card);
      throw Error{Fault::busy,
                  name_ + ": the GPU is in use, for example by a desktop; log out of it or use sdl:" + why};
    }
    mode_ = {output_.mode.hdisplay, output_.mode.vdisplay,
             output_.mode.clock * 1000.0 / (output_.mode.htotal * output_.mode.vtotal)};
    black_ = std::make_unique<DrmBuffer>(output_, name_);
    if (!show_black()) throw Error{Fault::absent, name_ + ": the connector rejects its own mode" + reason()};
    for (auto& image : images_) image = std::make_unique<DrmBuffer>(output_, name_);
    straighten_gamma(output_, name_);
    send_full_range(output_, name_);
    if (bits) limit_bits(output_, name_, *bits);
  }

  // Black stays on until the last copy of the card's handle is closed: master is not given up before the guardian has
  // gone, too.
  ~DrmDisplay() override {
    try {
      if (show_black()) order_.withdraw();
    } catch (...) {
      // The guardian is gone; black is on.
    }
    for (auto& image : images_) image.reset();
    close(output_.card);
  }

  DisplayMode mode() const override { return mode_; }

  int add(const GreyImage& levels) override {
    frames_.push_back(screen_bytes(levels, mode_));
    return count_of(frames_) - 1;
  }

  void exchange(ScreenFrames& frames) override {
    frames_.swap(frames);
    held_ = {-1, -1};  // the images hold frames of before
  }

  Flip present(int index) override {
    watch(index >= 0);
    const bool again = index >= 0 && held_[0] == index;  // it is on, or black followed it
    flip_.sequence = -1;
    drm_mode_crtc_page_flip order{};
    order.crtc_id = output_.crtc;
    order.fb_id = index < 0 ? black_->framebuffer() : again ? images_[0]->framebuffer() : ready(index);
    order.flags = DRM_MODE_PAGE_FLIP_EVENT;
    order.user_data = ++asked_;
    if (drmIoctl(output_.card, DRM_IOCTL_MODE_PAGE_FLIP, &order) != 0) {
      throw Error{fault_of_card(), name_ + ": the GPU rejected a page flip" + reason()};
    }
    wait_for_flip();
    require_connected();
    if (index < 0) order_.withdraw();
    if (!again) prepare(index + 1);
    return flip_;
  }

 private:
  // One image is on the screen; the other holds the frame to come, most often the next, or is filled now: within the
  // time of a vertical blank for 1920 x 1080 pixels.
  std::uint32_t ready(int index) {
    if (held_[1] != index) hold_back(index);
    std::swap(images_[0], images_[1]);
    std::swap(held_[0], held_[1]);
    return images_[0]->framebuffer();
  }
  void prepare(int next) {
    if (next >= count_of(frames_)) next = 0;
    if (!frames_.empty() && held_[1] != next) hold_back(next);
  }
  void hold_back(int index) {
    images_[1]->fill(frames_[index]);
    held_[1] = index;
  }

  bool show_black() {
    return drmModeSetCrtc(output_.card, output_.crtc, black_->framebuffer(), 0, 0, &output_.connector, 1,
                          &output_.mode) == 0;
  }

  // An event carries the number of its flip: that of an earlier one, given up as late, may come first.
  void read_events() {
    alignas(drm_event_vblank) std::array<char, 1024> bytes{};
    const ssize_t size = read(output_.card, bytes.data(), bytes.size());
    if (size < static_cast<ssize_t>(sizeof(drm_event))) throw Error{Fault::absent, name_ + ": the GPU is disconnected"};
    for (std::size_t at = 0; at + sizeof(drm_event_vblank) <= static_cast<std::size_t>(size);) {
      drm_event_vblank event{};
      std::memcpy(&event, bytes.data() + at, sizeof event);
      at += std::max<std::size_t>(event.base.length, sizeof(drm_event));
      if (event.base.type != DRM_EVENT_FLIP_COMPLETE || event.user_data != asked_) continue;
      flip_ = {static_cast<long>(event.sequence), event.tv_sec + 1e-6 * event.tv_usec};
    }
  }

  void wait_for_flip() {
    const double deadline_s = clock_.now_s() + flip_timeout_s;
    while (flip_.sequence < 0) {
      const double left_s = deadline_s - clock_.now_s();
      pollfd ready{output_.card, POLLIN, 0};
      const int count = left_s > 0 ? poll(&ready, 1, static_cast<int>(left_s * 1000) + 1) : 0;
      if (count < 0 && errno == EINTR) continue;
      if (count <= 0) {
        throw Error{Fault::busy, name_ + ": no flip within 0.25 s; is the screen on?"};
      }
      read_events();
    }
    check_interrupted();
  }

  void require_connected() {
    const double now_s = clock_.now_s();
    if (now_s - connected_s_ < unplugged_s) return;
    connected_s_ = now_s;
    if (is_connected(output_)) return;
    throw Error{Fault::absent, name_ + ": the screen was disconnected or switched off; check its cable and power"};
  }

  // The guardian shares the opened card, so that the images outlive the tool until black is on.
  void watch(bool lit) {
    if (lit) {
      order_.give({{"do", "drm"},
                   {"order", 0},
                   {"name", "screen"},
                   {"crtc", output_.crtc},
                   {"framebuffer", black_->framebuffer()}},
                  output_.card);
    }
    order_.beat();
  }

  Clock& clock_;
  StopOrder order_;
  DrmOutput output_;
  std::string name_;
  DisplayMode mode_;
  std::unique_ptr<DrmBuffer> black_;
  std::array<std::unique_ptr<DrmBuffer>, 2> images_;  // that was shown last, and the other
  std::array<int, 2> held_{-1, -1};                   // frames, in them
  ScreenFrames frames_;                               // grey, at a byte a pixel
  std::uint64_t asked_ = 0;                           // flips so far
  Flip flip_;
  double connected_s_ = 0;  // when it was looked at last
};

}  // namespace

std::unique_ptr<Display> open_drm_display(const Address& address, const DisplayMode&, Clock& clock,
                                          Guardian* guardian) {
  auto lock = std::make_unique<DeviceLock>(drm_lock + address.place);
  if (guardian != nullptr) guardian->keep(lock->handle());
  auto display = std::make_unique<DrmDisplay>(address.place, address.word("mode", ""), address.integer("bpc", 6, 16),
                                              clock, guardian);
  display->hold(std::move(lock));
  return display;
}

}  // namespace vam::device
