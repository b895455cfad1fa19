// SPDX-License-Identifier: GPL-3.0-or-later
// A video node by its path: what it is asked, and what a refusal means.
#pragma once

#include <cstring>
#include <memory>
#include <string>

#include "base/error.hpp"
#include "device/camera/v4l2_driver.hpp"

namespace vam::device {

template <class Struct>
Struct cleared() {
  Struct value;
  std::memset(&value, 0, sizeof value);
  return value;
}

struct V4l2Node {
  std::string path;
  std::unique_ptr<V4l2Driver> driver;

  [[nodiscard]] Error gone() const;
  /// By errno: absent when the camera is gone, else busy or protocol, "PATH: `what` (errno)".
  [[nodiscard]] Error refusal(const std::string& what) const;
  /// Throws refusal().
  void ask(unsigned long request, void* argument, const std::string& what) const;
};

}  // namespace vam::device
