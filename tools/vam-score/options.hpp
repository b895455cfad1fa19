// SPDX-License-Identifier: GPL-3.0-or-later
// The options of vam-score, for all its files.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cli/app.hpp"
#include "cli/common.hpp"
#include "score/score.hpp"
#include "session/grey_target.hpp"

namespace vam::score_tool {

struct Options {
  std::vector<std::string> inputs{"-"};
  std::string grid = "dose";
  std::string target;
  std::string sinogram;
  std::string require;
  std::string report;
  std::string table = "text";
  std::string lit_fraction;
  std::string print;
  std::string print_as = "mesh";
  std::optional<double> print_at;
  session::GreyChoice grey;
  score::ScoreOptions how;
  cli::PrinterOptions printer;
};

void declare(cli::App& app, Options& options);

}  // namespace vam::score_tool
