// SPDX-License-Identifier: GPL-3.0-or-later
// Commands that fit readings of other instruments (CSV), not frames of the camera. What they run throws Error:
// no_input, data (readings that do not determine the fit), no_output.
#pragma once

#include "cli/app.hpp"

namespace vam::calibrate_tool {

/// Light of the projector by grey level: the table of projector.response.
void add_photodiode(cli::App& app);

/// Cured thickness by exposure: the working curve of stereolithography [CURE19 fig 5a].
void add_cure_depth(cli::App& app);

}  // namespace vam::calibrate_tool
