// SPDX-License-Identifier: GPL-3.0-or-later
// What was measured of a resin, kept in a file for later runs.
#pragma once

#include <initializer_list>
#include <string>

#include "base/text/format_version.hpp"
#include "base/text/json_fwd.hpp"

namespace vam::io {

/// The gelation threshold I_p in the record that vam-calibrate resin or working-curve wrote. Throws Error: no_input,
/// data (not such a record, or its isovalue is not above 0).
[[nodiscard]] double gelation_isovalue(const std::string& path);

/// A JSON file of one of these schemas, its seal held to. Throws Error: no_input, data.
[[nodiscard]] Json sealed_record(const std::string& path, std::initializer_list<FormatKind> schemas);

}  // namespace vam::io
