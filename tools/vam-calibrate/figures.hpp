// SPDX-License-Identifier: GPL-3.0-or-later
// Commands that make figures of volumes, prints and readings of other instruments (CSV), not of the camera's frames.
// What they run throws Error: usage, no_input, data (also readings that do not determine a fit), no_output.
#pragma once

#include "cli/app.hpp"

namespace vam::calibrate_tool {

/// The gelation threshold as a resin record, from a printed standard.
void add_resin(cli::App& app);

/// Scattering against dose as a resin record, from a staircase of doses.
void add_working_curve(cli::App& app);

/// The dose at the surface of a print; judged where the surface does not follow the dose.
void add_critical_dose(cli::App& app);

/// Light of the projector by grey level: the table of projector.response.
void add_photodiode(cli::App& app);

/// Cured thickness by exposure: the working curve of stereolithography [CURE19 fig 5a].
void add_cure_depth(cli::App& app);

}  // namespace vam::calibrate_tool
