// SPDX-License-Identifier: GPL-3.0-or-later
// Test images to a screen or to files.
#pragma once

#include "cli/app.hpp"
#include "model/printer.hpp"
#include "vam-project/options.hpp"

namespace vam::project {

void show_pattern(const cli::App& app, const Options& options, const model::Projector& projector);

}  // namespace vam::project
