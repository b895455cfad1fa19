// SPDX-License-Identifier: GPL-3.0-or-later
// vam-sim's commands: each is declared, and what is returned runs it with the options that were parsed.
#pragma once

#include <functional>
#include <string>

#include "cli/app.hpp"

namespace vam::sim_tool {

/// A stage controller or a lamp's relay on a pseudo-terminal. What runs it throws Error: usage, absent, no_output.
[[nodiscard]] std::function<void()> declare_stage(cli::App& app, std::string& chosen);

/// A GigE Vision camera on an address of this machine. What runs it throws Error: usage, no_input, data, no_output,
/// busy.
[[nodiscard]] std::function<void()> declare_camera(cli::App& app, std::string& chosen);

}  // namespace vam::sim_tool
