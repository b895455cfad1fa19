// SPDX-License-Identifier: GPL-3.0-or-later
#include "vam-optimize/deadline.hpp"

#include <algorithm>
#include <chrono>

namespace vam::optimize_tool {

namespace {

/// What follows the last iteration, in iterations: scaling, counting and writing; judging the frames as they are shown
/// and on other printers; the proof.
double rest_iterations(const Options& options) {
  double rest = 3;
  if (options.bits) rest += 3;
  if (!options.robust.empty()) rest += 5 + options.yield_printers / 3.0;
  if (!options.certify.empty()) rest += 1.2 * optimize::certify_iterations;
  return rest;
}

}  // namespace

optimize::Deadline deadline_of(const Options& options) {
  using Clock = std::chrono::steady_clock;
  const auto now_s = [began = Clock::now()] { return std::chrono::duration<double>(Clock::now() - began).count(); };
  return {now_s, *options.budget_s, rest_iterations(options)};
}

optimize::Deadline share_of(optimize::Deadline deadline, double share) {
  const double now_s = deadline.now_s();
  deadline.end_s = now_s + share * std::max(0.0, deadline.end_s - now_s);
  deadline.rest_iterations = 1;
  return deadline;
}

}  // namespace vam::optimize_tool
