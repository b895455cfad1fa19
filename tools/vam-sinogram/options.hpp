// SPDX-License-Identifier: GPL-3.0-or-later
// The options of vam-sinogram, for all its files.
#pragma once

#include <optional>
#include <string>

#include "cli/app.hpp"
#include "cli/common.hpp"
#include "io/exr/stack.hpp"

namespace vam::sinogram_tool {

struct Options {
  std::string input = "-";
  std::string output = "-";
  std::string grid = "target";
  int angles = 360;
  std::optional<int> bins;
  std::string filter = "none";
  std::optional<double> cutoff;
  std::string negative = "keep";
  std::optional<double> absorption_per_mm;
  bool printer_absorption = false;
  bool at_wall = false;
  cli::PrinterOptions printer;
  io::StackOptions stack;
};

void declare(cli::App& app, Options& options);

}  // namespace vam::sinogram_tool
