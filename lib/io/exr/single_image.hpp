// SPDX-License-Identifier: GPL-3.0-or-later
// One image of intensity in an EXR file of another program.
#pragma once

#include <string>

#include "base/image.hpp"

namespace vam::io {

/// Row 0 at the top; values as they are. Parsed in a child. Throws Error: no_input, io, data (no EXR, damaged, several
/// channels without Y, a pixel that is not a finite number).
[[nodiscard]] Image read_exr_image(const std::string& path);

}  // namespace vam::io
