// SPDX-License-Identifier: GPL-3.0-or-later
// vam-correct renew: new light for a running print, once a turn.
#pragma once

#include <functional>
#include <string>

#include "cli/app.hpp"

namespace vam::correct_tool {

/// Declares the command. What is returned goes on as the script of that name, with the options that were parsed; it
/// throws Fault::no_input where that is not there.
[[nodiscard]] std::function<void()> declare_renew(cli::App& app, std::string& command);

}  // namespace vam::correct_tool
