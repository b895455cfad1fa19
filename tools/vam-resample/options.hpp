// SPDX-License-Identifier: GPL-3.0-or-later
// The options of vam-resample, for all its files.
#pragma once

#include <optional>
#include <string>

#include "cli/app.hpp"
#include "cli/common.hpp"
#include "io/exr/stack.hpp"
#include "optics/resample_stack.hpp"

namespace vam::resample_tool {

struct Options {
  std::string input = "-";
  std::string output = "-";
  std::string geometry = "vial";
  std::string interpolation = "cubic";
  bool no_fresnel = false;
  bool no_jacobian = false;
  bool fresnel = false;
  bool jacobian = false;
  std::string negative = "clip";
  double angle_offset_deg = 0;
  optics::AxisAlignment alignment;
  std::optional<double> bin_width_mm;
  std::optional<int> bins;
  bool explain = false;
  std::optional<int> row;  // of the projector, whose rays to explain
  cli::PrinterOptions printer;
  io::StackOptions stack;
  /// Whether the columns are those of the projector, whose rays the vial refracts.
  [[nodiscard]] bool in_vial() const { return geometry == "vial"; }
};

void declare(cli::App& app, Options& options);
/// Throws Fault::usage for options that have no meaning in this direction, and for rows that the projector lacks.
void check(const Options& options, const model::Printer& printer);

}  // namespace vam::resample_tool
