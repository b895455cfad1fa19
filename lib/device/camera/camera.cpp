// SPDX-License-Identifier: GPL-3.0-or-later
#include "device/camera/camera.hpp"

#include "base/error.hpp"
#include "device/camera/camera_backends.hpp"

namespace vam::device {

double CameraSettings::patience_s(double period_s) const {
  return timeout_s.value_or(1 + 3 * period_s + 1e-6 * exposure_us.value_or(0));
}

std::optional<std::string> another_size(const CameraMode& mode, int columns, int rows) {
  if (columns == mode.columns && rows == mode.rows) return std::nullopt;
  const auto size = [](int across, int down) { return std::to_string(across) + " x " + std::to_string(down); };
  return size(columns, rows) + " pixels instead of " + size(mode.columns, mode.rows);
}

bool in_real_pace(const Address& address, const std::string& fallback) {
  const std::string pace = address.word("pace", fallback);
  if (pace != "real" && pace != "virtual") {
    throw Error{Fault::usage, "device '" + address.text + "': pace=" + pace + ": expected real or virtual"};
  }
  return pace == "real";
}

}  // namespace vam::device
