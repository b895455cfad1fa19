// SPDX-License-Identifier: GPL-3.0-or-later
// A device that is there, as vam-devices lists it.
#pragma once

#include <string>

namespace vam::device {

struct DeviceListing {
  std::string kind;      // stage, camera, display or light
  std::string device;    // the device string
  std::string about;     // maker, model, serial number, size: what is known without using it
  std::string obstacle;  // why it cannot be used now, and the remedy; empty when nothing is in the way
};

/// What keeps this user from a device node: no permission, with the group to join, or another user of these tools, with
/// the pid. Empty when nothing does.
[[nodiscard]] std::string node_obstacle(const std::string& path);

/// Who holds the lock of that name (DeviceLock): "in use by process 4711"; empty when nobody does.
[[nodiscard]] std::string lock_obstacle(const std::string& name);

}  // namespace vam::device
