// SPDX-License-Identifier: GPL-3.0-or-later
#include "device/projector/private/drm_buffer.hpp"

#include <sys/mman.h>
#include <xf86drm.h>

#include <cerrno>
#include <cstring>

#include "base/error.hpp"

namespace vam::device {

DrmBuffer::DrmBuffer(const DrmOutput& output, const std::string& name) : card_(output.card) {
  memory_.width = output.mode.hdisplay;
  memory_.height = output.mode.vdisplay;
  memory_.bpp = 32;
  drm_mode_map_dumb where{};
  void* pixels = MAP_FAILED;
  if (drmIoctl(card_, DRM_IOCTL_MODE_CREATE_DUMB, &memory_) == 0) {
    where.handle = memory_.handle;
    const bool shown =
        drmModeAddFB(card_, memory_.width, memory_.height, 24, 32, memory_.pitch, memory_.handle, &framebuffer_) == 0;
    if (shown && drmIoctl(card_, DRM_IOCTL_MODE_MAP_DUMB, &where) == 0) {
      pixels = mmap(nullptr, memory_.size, PROT_READ | PROT_WRITE, MAP_SHARED, card_, static_cast<off_t>(where.offset));
    }
  }
  if (pixels == MAP_FAILED) {
    const std::string why = std::strerror(errno);
    release();
    throw Error{Fault::memory, name + ": no GPU memory for an image of " + std::to_string(output.mode.hdisplay) +
                                   " x " + std::to_string(output.mode.vdisplay) + " pixels (" + why + ")"};
  }
  pixels_ = pixels;
  std::memset(pixels_, 0, memory_.size);
}

DrmBuffer::~DrmBuffer() { release(); }

void DrmBuffer::release() {
  if (pixels_ != nullptr) munmap(pixels_, memory_.size);
  if (framebuffer_ != 0) drmModeRmFB(card_, framebuffer_);
  drm_mode_destroy_dumb gone{memory_.handle};
  if (memory_.handle != 0) drmIoctl(card_, DRM_IOCTL_MODE_DESTROY_DUMB, &gone);
}

void DrmBuffer::fill(const std::vector<std::uint8_t>& grey) {
  const std::uint8_t* from = grey.data();
  for (std::uint32_t y = 0; y < memory_.height; ++y) {
    auto* row =
        reinterpret_cast<std::uint32_t*>(static_cast<char*>(pixels_) + static_cast<std::size_t>(y) * memory_.pitch);
    for (std::uint32_t x = 0; x < memory_.width; ++x) row[x] = *from++ * 0x010101U;
  }
}

}  // namespace vam::device
