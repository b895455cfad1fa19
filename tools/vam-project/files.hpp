// SPDX-License-Identifier: GPL-3.0-or-later
// Frames to files.
#pragma once

#include "cli/app.hpp"
#include "io/exr/stack.hpp"
#include "model/printer.hpp"
#include "vam-project/options.hpp"
#include "vam-project/slices.hpp"

namespace vam::project {

/// A frame for every frame period of the projector while the stage turns.
void write_turns(const cli::App& app, const Options& options, const model::Printer& printer, io::StackReader& reader);

/// Each slice once.
void write_slices(const cli::App& app, const Options& options, const model::Printer& printer, const SliceStack& slices);

}  // namespace vam::project
