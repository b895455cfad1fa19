// SPDX-License-Identifier: GPL-3.0-or-later
// --report: measured figures as JSON, for scripts.
#pragma once

#include <string>

#include "base/json_fwd.hpp"

namespace vam::io {

/// Writes {"schema": "<tool>/<version>", ...figures}; units are in the keys. Nothing when path is empty; "-" is stdout.
/// The schema's version counts up when a key changes its meaning or goes. Throws Error: no_output, io.
void write_report(const std::string& path, const std::string& schema, const Json& figures);

}  // namespace vam::io
