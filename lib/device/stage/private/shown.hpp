// SPDX-License-Identifier: GPL-3.0-or-later
// Answers of a controller in error messages.
#pragma once

#include <string>

namespace vam::device {

/// At most 40 bytes, those that are not ASCII text as \xNN.
[[nodiscard]] std::string shown(const std::string& bytes);

}  // namespace vam::device
