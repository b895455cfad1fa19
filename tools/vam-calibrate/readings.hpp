// SPDX-License-Identifier: GPL-3.0-or-later
// Commands that fit readings of other instruments (CSV), not frames of the camera. Each is declared, and what is
// returned runs it; it throws Error: no_input, data (readings that do not determine the fit), no_output.
#pragma once

#include <functional>
#include <string>

#include "cli/app.hpp"

namespace vam::calibrate_tool {

/// Light of the projector by grey level: the table of projector.response.
[[nodiscard]] std::function<void()> declare_photodiode(cli::App& app, std::string& command);

/// Cured thickness by exposure: the working curve of stereolithography [CURE19 fig 5a].
[[nodiscard]] std::function<void()> declare_cure_depth(cli::App& app, std::string& command);

}  // namespace vam::calibrate_tool
