// SPDX-License-Identifier: GPL-3.0-or-later
// An image in a graphics card's memory, which a screen can show.
#pragma once

#include <xf86drmMode.h>

#include <cstdint>
#include <string>
#include <vector>

#include "device/projector/private/drm_output.hpp"

namespace vam::device {

/// A dumb buffer of the output's mode, 32 bits a pixel, black at first.
class DrmBuffer {
 public:
  /// `name` is for messages. Throws Fault::memory.
  DrmBuffer(const DrmOutput& output, const std::string& name);
  ~DrmBuffer();
  DrmBuffer(const DrmBuffer&) = delete;
  DrmBuffer& operator=(const DrmBuffer&) = delete;

  [[nodiscard]] std::uint32_t framebuffer() const { return framebuffer_; }
  /// Grey of the mode's size, row by row. Not while it is on the screen.
  void fill(const std::vector<std::uint8_t>& grey);

 private:
  void release();
  int card_;
  drm_mode_create_dumb memory_{};
  void* pixels_ = nullptr;
  std::uint32_t framebuffer_ = 0;
};

}  // namespace vam::device
