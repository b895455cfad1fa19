// SPDX-License-Identifier: GPL-3.0-or-later
// A camera's setting is what it reads back as, not what it was set to.
#pragma once

#include <string>

namespace vam::device {

/// `subject`: the camera and the setting. Throws Fault::protocol where `got` differs from `wanted` by more than 1 % and
/// `grain`, the step of the setting.
void require_read_back(const std::string& subject, double wanted, double got, double grain);

}  // namespace vam::device
