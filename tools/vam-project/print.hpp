// SPDX-License-Identifier: GPL-3.0-or-later
// Frames to a screen, in step with the stage.
#pragma once

#include "cli/app.hpp"
#include "model/printer.hpp"
#include "model/stack.hpp"
#include "session/exposure.hpp"
#include "vam-project/options.hpp"
#include "vam-project/turn.hpp"

namespace vam::project {

/// Of a live print, of whole turns. Throws Fault::usage when they are not whole, when
/// the print would begin after them (--from), or when the poses of the stack are not those of one turn that repeats.
[[nodiscard]] session::Exposure whole_exposure(const Options& options, const model::StackInfo& info, const Light& light,
                                               const model::Printer& printer);

/// A sinogram by the stage's angle, or slices by time; stack: null for a folder of slices. Throws as whole_exposure().
void print_live(const cli::App& app, const Options& options, const model::Printer& printer, io::StackReader* stack);

}  // namespace vam::project
