// SPDX-License-Identifier: GPL-3.0-or-later
// One user per device. The lock is released when its holder ends (flock), however it ends [devices guarantee 4].
#pragma once

#include <string>
#include <vector>

#include "base/error.hpp"

namespace vam::device {

/// Fault::busy: another process holds the lock.
struct InUse : Error {
  InUse(const std::string& line, int process) : Error(Fault::busy, line), holder(process) {}
  int holder;  // seen to hold it, itself or as its guardian; 0: a process of another user
};

/// Holds the device of that name for this process and, through handle(), for its guardian until the device is safe.
/// The name is a path of a device node (links are followed, so /dev/serial/by-id/X and /dev/ttyUSB0 are one) or any
/// other unique text ("usb-1ffb-00b3-00312345"). Throws InUse naming the holder's pid, Fault::no_output when no lock
/// can be made. Lock files are in $VAM_LOCK_DIR, or /run/lock, or /tmp; each holds its holder's pid.
class DeviceLock {
 public:
  explicit DeviceLock(const std::string& name);
  ~DeviceLock();
  DeviceLock(const DeviceLock&) = delete;
  DeviceLock& operator=(const DeviceLock&) = delete;
  [[nodiscard]] int handle() const { return fd_; }

 private:
  int fd_ = -1;
};

/// Names of devices that are locked now and begin so: "drm-" gives "drm-HDMI-A-1". Nothing is written, and a lock that
/// is taken meanwhile is not refused.
[[nodiscard]] std::vector<std::string> locked_names(const std::string& beginning);

}  // namespace vam::device
