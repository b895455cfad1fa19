// SPDX-License-Identifier: GPL-3.0-or-later
// The size of an image, as text.
#pragma once

#include <string>

#include "base/image.hpp"
#include "base/text/text.hpp"

namespace vam {

/// "640 x 480", columns and rows.
[[nodiscard]] inline std::string size_text(const Image& image) { return size_text(image.width, image.height); }

}  // namespace vam
