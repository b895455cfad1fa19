// SPDX-License-Identifier: GPL-3.0-or-later
// vam-correct renew: new light for a running print, once a turn.
#pragma once

#include "cli/app.hpp"

namespace vam::correct_tool {

/// The command: replaces this process by the script of that name. It throws Fault::no_input where that is not there.
void add_renew(cli::App& app);

}  // namespace vam::correct_tool
