// What the user asks of vam-optimize, for all its files.
#pragma once

#include <optional>
#include <string>

#include "cli/app.hpp"
#include "cli/common.hpp"
#include "io/exr_stack.hpp"
#include "optimize/iterate.hpp"

namespace vam::optimize_tool {

struct Options {
  std::string input = "-";
  std::string output = "-";
  std::string method = "auto";
  std::string geometry = "parallel";
  int angles = 360;
  std::optional<int> columns;
  std::optional<int> iterations;
  optimize::Limits limits;
  std::string until;
  std::string init;
  std::string trace;
  std::string report;
  std::string negative = "clip";
  std::string absorption = "exact";
  bool no_threshold = false;
  optimize::MethodOptions how;
  std::optional<int> bits;
  std::optional<double> peak;
  bool error_feedback = false;
  cli::PrinterOptions printer;
  io::StackOptions stack;
};

[[nodiscard]] cli::Manual manual();
void declare(cli::App& app, Options& options);
/// Fills in what follows from other options. Throws Fault::usage for options that contradict each other.
void settle(const cli::App& app, Options& options);

}  // namespace vam::optimize_tool
