// SPDX-License-Identifier: GPL-3.0-or-later
// Private to the EXR files: the values that a stack may have.
#pragma once

#include <cstddef>
#include <string>

#include "base/image.hpp"
#include "model/stack.hpp"

namespace vam::io::exr {

/// "pixel 3, 4 of image 2 is 1e+30, more than 1e9, ..." of the first value that is not finite, or of projections is no
/// intensity; empty where there is none.
[[nodiscard]] std::string objection(const Image& image, std::size_t index, model::Space space);

}  // namespace vam::io::exr
