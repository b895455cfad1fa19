// SPDX-License-Identifier: GPL-3.0-or-later
// Whether a printer file still has its end: what a cut takes away is at its default, in silence.
#pragma once

#include <string>
#include <string_view>

namespace vam::io {

/// The first and the last line of a printer file that these tools write, and the last one of any that says it is whole.
inline constexpr std::string_view printer_head =
    "# Printer settings of the VAM tools, to the line \"# end of the settings\".";
inline constexpr std::string_view printer_end = "# end of the settings";

/// Throws Fault::data where a text has the first line, and not the last one.
void require_own_end(std::string_view text, const std::string& subject);

}  // namespace vam::io
