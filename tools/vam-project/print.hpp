// SPDX-License-Identifier: GPL-3.0-or-later
// Frames to a screen, in step with the stage.
#pragma once

#include "cli/app.hpp"
#include "model/printer.hpp"
#include "model/stack.hpp"
#include "vam-project/options.hpp"

namespace vam::project {

/// Whole turns of a live print, by --turns or the printer's stage. Throws Fault::usage when they are not whole, when
/// the print would begin after them (--from), or when the poses of the stack are not those of one turn that repeats.
[[nodiscard]] int turns_to_show(const Options& options, const model::StackInfo& info, const model::Printer& printer);

/// A sinogram by the stage's angle, or slices by time. Throws as turns_to_show().
void print_live(const cli::App& app, const Options& options, const model::Printer& printer);

}  // namespace vam::project
