// SPDX-License-Identifier: GPL-3.0-or-later
// The same bench at half of the resolution: every pixel is two of the finer ones in each direction.
#pragma once

#include "model/printer.hpp"

namespace vam::model {

/// Column c covers columns 2 c and 2 c + 1, row r rows 2 r and 2 r + 1; the lens stays where it is.
[[nodiscard]] Printer coarser(const Printer& printer);

}  // namespace vam::model
