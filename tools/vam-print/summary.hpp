// SPDX-License-Identifier: GPL-3.0-or-later
// The records that a print leaves when it has ended, however it ended.
#pragma once

#include "vam-print/run.hpp"
#include "vam-print/shown_light.hpp"

namespace vam::print_tool {

/// Something moved, was lit or taken.
[[nodiscard]] bool is_used(const Run& run, const ShownLight& light);

/// Where vam-project was killed: when its last image went off, of which its log says nothing.
void log_dark(const Run& run, const ShownLight& light);

/// summary.json and SHA256SUMS, and what the tools said. Throws Error where the disk has no room.
void write_summary(const Run& run, const ShownLight& light, int status);

}  // namespace vam::print_tool
