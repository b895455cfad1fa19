// SPDX-License-Identifier: GPL-3.0-or-later
// What a live print would be: for people, before it begins.
#pragma once

#include "io/exr/stack.hpp"
#include "model/printer.hpp"
#include "vam-project/options.hpp"

namespace vam::project {

/// Reads the stack, opens display and light engine, which stay dark, and prints a line each on frames, duration,
/// light, dose and the two devices. Throws as a live print does before its first frame.
void print_plan(const cli::App& app, const Options& options, const model::Printer& printer, io::StackReader& reader);

/// The lines on the devices alone: all that there is to say of a test pattern.
void print_devices(const Options& options, const model::Printer& printer);

}  // namespace vam::project
