// SPDX-License-Identifier: GPL-3.0-or-later
// Several resins for one part: how fast, and how narrow a gap stays open.
#pragma once

#include "vam-curethrough/subcommands.hpp"

namespace vam::curethrough {

/// Prints the table on standard output and returns it for the report.
[[nodiscard]] Json compare(const CorrectOptions& options, const PrintSettings& print, const resin::PartColumns& part);

}  // namespace vam::curethrough
