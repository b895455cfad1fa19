// SPDX-License-Identifier: GPL-3.0-or-later
// What a live print would be: for people, before it begins.
#pragma once

#include <optional>

#include "model/printer.hpp"
#include "model/stack.hpp"
#include "vam-project/options.hpp"

namespace vam::project {

/// The dose after these turns where that of one is the threshold that vam-optimize aimed at; full_scale: the sinogram's
/// value at full intensity. None where the sinogram states no threshold, or the resin or lamp is not known.
[[nodiscard]] std::optional<double> dose_at_threshold_mj_cm3(const model::StackInfo& info,
                                                             const model::Printer& printer, double turns,
                                                             double full_scale);

/// Reads the sinogram, opens display and light engine, which stay dark, and prints a line each on frames, duration,
/// light, dose and the two devices. Throws as a live print does before its first frame.
void print_plan(const cli::App& app, const Options& options, const model::Printer& printer);

/// The lines on the devices alone: all that there is to say of a test pattern.
void print_devices(const Options& options, const model::Printer& printer);

}  // namespace vam::project
