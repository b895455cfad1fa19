// SPDX-License-Identifier: GPL-3.0-or-later
// vam-curethrough's commands. What they run throws Error: usage, no_input, data, no_output.
#pragma once

#include "cli/app.hpp"

namespace vam::curethrough {

/// Dose and cure map of slices.
void add_model(cli::App& app);

/// Slices without cure-through.
void add_correct(cli::App& app);

/// Height errors of a ladder by parameters.
void add_sweep(cli::App& app);

}  // namespace vam::curethrough
