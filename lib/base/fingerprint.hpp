// SPDX-License-Identifier: GPL-3.0-or-later
// The fingerprint of an image's grey levels, by which logs of cameras and manifests of captures tell images apart.
#pragma once

#include <string>

#include "base/pixels.hpp"

namespace vam {

/// 16 hexadecimal digits: FNV-1a, 64 bits, of the levels row by row, a byte each up to 8 bits, else two, the lower one
/// first.
[[nodiscard]] std::string fingerprint(const GreyImage& levels);

}  // namespace vam
