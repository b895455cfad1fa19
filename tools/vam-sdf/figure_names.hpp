// SPDX-License-Identifier: GPL-3.0-or-later
// Names of figures in conditions and messages, and where the report has them.
#pragma once

#include <string>
#include <vector>

#include "metrology/compare/regions.hpp"

namespace vam::sdf_tool {

/// "rms", ..., and "top.flatness" of every region.
[[nodiscard]] std::vector<std::string> figure_names(const std::vector<metrology::Region>& regions);

/// As a JSON pointer: "/regions/top/flatness_mm".
[[nodiscard]] std::string place_of(const std::string& name);

}  // namespace vam::sdf_tool
