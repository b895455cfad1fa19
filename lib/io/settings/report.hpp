// SPDX-License-Identifier: GPL-3.0-or-later
// --report: measured figures as JSON, for scripts.
#pragma once

#include <string>

#include "base/text/format_version.hpp"
#include "base/text/json_fwd.hpp"

namespace vam::io {

/// Writes {"schema": "<tool>/<version>", ...figures}; units are in the keys. Nothing when path is empty; "-" is stdout.
/// Throws Error: no_output, io.
void write_report(const std::string& path, FormatKind schema, const Json& figures);

}  // namespace vam::io
