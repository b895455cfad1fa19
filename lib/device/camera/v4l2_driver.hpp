// SPDX-License-Identifier: GPL-3.0-or-later
// What the V4L2 backend asks of the kernel; a test may stand in for it.
#pragma once

#include <cstddef>
#include <memory>

namespace vam::device {

/// The system calls on a video node, with their results and errno.
class V4l2Driver {
 public:
  virtual ~V4l2Driver() = default;
  virtual int open(const char* path) = 0;
  virtual int control(unsigned long request, void* argument) = 0;  // ioctl
  virtual void* map(std::size_t size, std::size_t offset) = 0;     // MAP_FAILED for none
  virtual void unmap(void* start, std::size_t size) = 0;
  /// 1: something to read; 0: not within so long, or a signal asks the tool to end; -1: the stream has ended, the
  /// device may be gone; errno tells nothing.
  virtual int wait(double seconds) = 0;
  virtual void close() = 0;
};

[[nodiscard]] std::unique_ptr<V4l2Driver> kernel_v4l2();

}  // namespace vam::device
