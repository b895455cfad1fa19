// SPDX-License-Identifier: GPL-3.0-or-later
// vam-capture's plain form and identify.
#pragma once

#include "cli/app.hpp"
#include "vam-capture/options.hpp"

namespace vam::capture_tool {

void identify(const cli::App& app, const Options& options);
void take(const cli::App& app, const Options& options);

}  // namespace vam::capture_tool
