// SPDX-License-Identifier: GPL-3.0-or-later
// Values for the script of a page, and what the script and the style are.
#pragma once

#include <string>

#include "base/text/json_fwd.hpp"

namespace vam::report_tool {

/// A data block that no browser runs. Every < is escaped, so that no text in it can end it.
[[nodiscard]] std::string page_data(const Json& values);

extern const char* const page_script;
extern const char* const page_style;

}  // namespace vam::report_tool
