// SPDX-License-Identifier: GPL-3.0-or-later
// Whether the sinogram was computed for the printer that is to show it.
#pragma once

#include <string>
#include <vector>

#include "model/printer.hpp"
#include "model/stack.hpp"
#include "vam-project/options.hpp"

namespace vam::project {

/// Compares vam:printer of a projector sinogram with the printer. Throws Fault::data where they differ, which with
/// --accept-printer is a warning; one that does not say is a warning, too. Throws Fault::data where the printer's axis
/// is beside its columns. Returns the differences, for the report.
std::vector<std::string> require_printer(const Options& options, const model::StackInfo& info,
                                         const model::Printer& printer);

/// Says where frames that are `frame_deg` apart show the projections over other stage angles than they were judged
/// with.
void tell_width(const std::string& input, const model::StackInfo& info, double frame_deg);

/// Throws Fault::data for a piece of a stack, whose other slices would stay dark.
void require_whole(const std::string& input, const model::StackInfo& info);

}  // namespace vam::project
