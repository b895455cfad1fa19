// SPDX-License-Identifier: GPL-3.0-or-later
// --preview: whether the part will print, for how long and where not, by few iterations on coarse voxels.
#pragma once

#include "model/printer.hpp"
#include "session/job_volumes.hpp"
#include "vam-optimize/options.hpp"

namespace vam::optimize_tool {

/// Text on standard output, figures to --report. Throws as optimise() does.
void preview(const model::Printer& printer, const session::JobVolumes& in, const Options& options);

}  // namespace vam::optimize_tool
