// Frames to a screen, in step with the stage.
#pragma once

#include "cli/app.hpp"
#include "model/printer.hpp"
#include "vam-project/options.hpp"

namespace vam::project {

/// A sinogram by the stage's angle, or slices by time. Throws Fault::usage for turns that are not whole.
void print_live(const cli::App& app, const Options& options, const model::Printer& printer);

}  // namespace vam::project
