// SPDX-License-Identifier: GPL-3.0-or-later
// Options of vam-view.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cli/app.hpp"
#include "cli/common.hpp"
#include "plot/view.hpp"

namespace vam::view_tool {

struct Options {
  std::string input = "-";
  std::string output = "-";
  std::string grid;
  std::string plane = "axial";
  std::string target;
  std::string exported;
  std::string title;
  double dpi = plot::screen_dpi;
  std::vector<std::string> compare;
  std::string crop = "all";
  std::optional<double> threshold;
  bool histogram = false;
  bool cure = false;
  bool render = false;
  bool plain = false;
  plot::ViewOptions view;
  cli::PrinterOptions printer;
};

/// Without folders; "stdin" for -.
[[nodiscard]] std::string file_name(const std::string& path);
/// FILE and those of --compare, each with its folder where another one is called the same, as of two runs.
[[nodiscard]] std::vector<std::string> file_names(const Options& options);

void declare(cli::App& app, Options& options);

}  // namespace vam::view_tool
