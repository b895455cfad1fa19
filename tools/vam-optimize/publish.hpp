// Warnings and reports of a finished run.
#pragma once

#include <optional>

#include "model/printer.hpp"
#include "model/stack.hpp"
#include "optimize/run/volume.hpp"
#include "optimize/run/yield.hpp"
#include "vam-optimize/options.hpp"

namespace vam::optimize_tool {

/// Warnings on stderr; the files of --trace and --report where they are requested.
void publish(const optimize::VolumeOutcome& outcome, const std::optional<optimize::Trials>& trials,
             const model::Printer& printer, const model::StackInfo& info, const Options& options);

}  // namespace vam::optimize_tool
