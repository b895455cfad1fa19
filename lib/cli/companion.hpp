// SPDX-License-Identifier: GPL-3.0-or-later
// Files of a tool that are no commands: in lib/vam, beside the bin/ of a build or of what is installed.
#pragma once

#include <string>

namespace vam::cli {

/// The path of the file of that name. Throws Fault::no_input where it is not there.
[[nodiscard]] std::string companion(const std::string& name);

/// From here on what this process starts finds the tools beside this one before others.
void find_tools_beside();

}  // namespace vam::cli
