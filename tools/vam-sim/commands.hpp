// SPDX-License-Identifier: GPL-3.0-or-later
// vam-sim's commands.
#pragma once

#include "cli/app.hpp"

namespace vam::sim_tool {

/// A stage controller or a lamp's relay on a pseudo-terminal. Its run throws Error: usage, absent, no_output.
void add_stage(cli::App& app);

/// A GigE Vision camera on an address of this machine. Its run throws Error: usage, no_input, data, no_output, busy.
void add_camera(cli::App& app);

}  // namespace vam::sim_tool
