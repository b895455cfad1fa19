// SPDX-License-Identifier: GPL-3.0-or-later
// The options of vam-optimize, for all its files.
#pragma once

#include <optional>
#include <string>

#include "cli/app.hpp"
#include "cli/common.hpp"
#include "io/exr/stack.hpp"
#include "optimize/run/volume.hpp"
#include "session/job_options.hpp"

namespace vam::optimize_tool {

/// Kinds of target of which no dose of part, or of void, is demanded.
inline constexpr const char* grey_part = "grey targets without a step or logistic response";
inline constexpr const char* grey_void = "grey targets without a step or logistic response and --void below";

/// Those of the job, its method and its results.
struct Options : session::JobOptions {
  std::string output = "-";
  std::string method = "auto";
  std::string response = "logistic";
  std::optional<int> iterations;  // stopping criteria
  optimize::Limits limits;
  std::string until;
  std::string init;
  std::string checkpoint;
  std::string slices;  // of the stack, that are written; empty: all
  std::string trace;
  optimize::MethodOptions how;
  std::optional<double> max_intensity;
  bool shortest = false;
  std::string tradeoff;
  std::string certify;
  std::optional<double> budget_s;
  optimize::IntensityLimit limit;
  optimize::Raising raising;
  std::string robust;
  bool tolerances = false;
  bool recorded_tolerances = false;  // of the printer, from the calibration records
  std::optional<int> bits;           // the projector's grey levels
  double column_offset_px = 0;
  cli::PrinterOptions printer;
  std::string report;
  io::StackOptions stack;
};

/// As many angles as the projections have from which it starts, unless --angles says otherwise. Throws as StackReader.
void resolve_angles(const cli::App& app, Options& options);

void declare(cli::App& app, Options& options);
/// Fills in what follows from the printer file's settings and from other options, no other file opened. Throws
/// Fault::usage for values that cannot be.
void resolve(const cli::App& app, const model::Printer& printer, Options& options);
/// The tolerances of calibration records where --robust asks for them and names no others; one line on a terminal says
/// which. Throws as io::recorded_tolerances does.
void resolve_recorded(const model::Printer& printer, Options& options);
/// The response curve of --resin-response, and the window that a table of it gives. Throws Error when it cannot be
/// read.
void resolve_response(const cli::App& app, Options& options);

}  // namespace vam::optimize_tool
