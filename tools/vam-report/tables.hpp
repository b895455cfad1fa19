// SPDX-License-Identifier: GPL-3.0-or-later
// Figures, iterations and provenance as tables and curves.
#pragma once

#include <string>
#include <vector>

#include "base/text/json_fwd.hpp"

namespace vam::report_tool {

/// HTML: one row a figure, those of objects within as "with_surface.ver".
[[nodiscard]] std::string figures_table(const Json& figures);

/// HTML of a report in JSON, folded. Throws Fault::data for a seal that is not its own, and what reading throws.
[[nodiscard]] std::string report_table(const std::string& path);

/// HTML: VER and process window over the iterations. Throws what read_csv throws.
[[nodiscard]] std::string convergence(const std::string& path);

/// HTML: the commands that each file was made by, with the seals of what they wrote.
[[nodiscard]] std::string provenance(const std::vector<std::string>& paths);

}  // namespace vam::report_tool
