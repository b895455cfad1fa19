// SPDX-License-Identifier: GPL-3.0-or-later
// Times of day that people and records share: UTC, ISO 8601.
#pragma once

#include <string>

namespace vam {

/// Now, in seconds since 1970, UTC.
[[nodiscard]] double utc_seconds();

/// "2026-11-21T16:58:00.123Z"
[[nodiscard]] std::string utc_text(double utc_s);

/// The same time as a number. Throws Fault::data.
[[nodiscard]] double parse_utc(const std::string& text, const std::string& subject);

}  // namespace vam
