// SPDX-License-Identifier: GPL-3.0-or-later
// The light that prints have truly given, instead of one turn of all that the sinogram asks for.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/image.hpp"
#include "cli/common.hpp"
#include "model/printer.hpp"
#include "model/stack.hpp"
#include "vam-dose/options.hpp"

namespace vam::dose_tool {

/// The printer that the options name; where none is named, that of the run: what it froze.
[[nodiscard]] cli::PrinterOptions printer_of(const Options& options);

/// Where a print is given by --shown and no sinogram, neither by name nor on standard input: that which the run folder
/// has. Throws Fault::usage where it has none, or showed several; Fault::no_input where its link leads nowhere.
void take_sinogram(const cli::App& app, Options& options);

/// Takes the full scale at which a run of --shown showed the sinogram, if it states it. Throws Fault::usage where
/// --full-scale says otherwise, Fault::data for a run whose logs or settings were changed since its end.
void take_full_scale(Options& options);

/// The full scale at which the first run of --shown showed a sinogram. Throws Fault::data where it does not state it.
[[nodiscard]] double shown_full_scale(const Options& options, const std::string& sinogram);

/// Turns for which each row of the sinogram was shown at this full scale, summed over the runs of --shown; empty
/// without. Throws Fault::data where the stack is none of a projector, or a run used another stack or other settings of
/// the light.
[[nodiscard]] std::vector<double> shown_turns(const Options& options, const std::string& sinogram,
                                              const std::optional<double>& full_scale, const model::StackInfo& info,
                                              const model::Printer& printer);

/// How often each row is shown in that many turns that begin with the first one, over their mean; empty for whole
/// turns.
[[nodiscard]] std::vector<double> shares_of(double turns, int rows);

/// Throws Fault::usage where a run of --shown showed a sinogram that is not given: the dose would lack its light.
void require_all_sinograms(const Options& options);

/// Multiplies each row by its turns; nothing when `turns` is empty.
void weigh(const std::vector<double>& turns, std::span<Image> sinograms);

}  // namespace vam::dose_tool
