// SPDX-License-Identifier: GPL-3.0-or-later
// A screen that shows preloaded frames at its vertical blanks: the image input of a projector [devices §4].
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "base/pixels.hpp"
#include "device/os/address.hpp"
#include "device/os/clock.hpp"
#include "device/os/lock.hpp"
#include "device/safety/guardian.hpp"

namespace vam::device {

struct DisplayMode {
  int columns = 0;
  int rows = 0;
  double hz = 60;
};

/// A frame that has come on: the number of its vertical blank and when that was, on CLOCK_MONOTONIC.
struct Flip {
  long sequence = 0;
  double time_s = 0;
};

/// Frames as a screen takes them: screen_bytes() each.
using ScreenFrames = std::vector<std::vector<std::uint8_t>>;

/// Black from the constructor to the destructor's end, except between present() of a frame and the next black one.
/// Frames are 8-bit grey (fewer bits are spread to 0..255). Throws Error: absent (no such screen), busy (in use, or no
/// flip in time), data (a frame of another size).
class Display {
 public:
  virtual ~Display() = default;
  [[nodiscard]] virtual DisplayMode mode() const = 0;
  /// Preloads a frame and returns its index: 0, 1, ...
  virtual int add(const GreyImage& levels) = 0;
  /// Takes these frames in place of all that it has, which it gives back, at once: what is on stays on until present().
  virtual void exchange(ScreenFrames& frames) = 0;
  /// Shows frame `index`, or black for -1, from the next vertical blank on; returns when it is on.
  virtual Flip present(int index) = 0;

  void hold(std::unique_ptr<DeviceLock> lock) { lock_ = std::move(lock); }

 private:
  std::unique_ptr<DeviceLock> lock_;
};

/// 8-bit bytes, row-major, of a frame of this size. Throws Fault::data for another size, Fault::usage for more than 8
/// bits.
[[nodiscard]] std::vector<std::uint8_t> screen_bytes(const GreyImage& levels, const DisplayMode& mode);

}  // namespace vam::device
