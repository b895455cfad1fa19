// SPDX-License-Identifier: GPL-3.0-or-later
#include "device/camera/camera.hpp"

#include <cmath>

#include "base/error.hpp"
#include "base/text/text.hpp"
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

void require_read_back(const std::string& subject, double wanted, double got, double grain) {
  constexpr double tolerance = 0.01;
  if (std::abs(wanted - got) <= tolerance * std::abs(wanted) + grain) return;
  throw Error{Fault::protocol, subject + " reads back as " + format_number(got) + " instead of " +
                                   format_number(wanted) + "; choose a supported value"};
}

bool in_real_pace(const Address& address, const std::string& fallback) {
  const std::string pace = address.word("pace", fallback);
  if (pace != "real" && pace != "virtual") {
    throw Error{Fault::usage, "device '" + address.text + "': pace=" + pace + ": expected real or virtual"};
  }
  return pace == "real";
}

}  // namespace vam::device
