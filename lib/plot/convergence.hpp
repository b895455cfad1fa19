// SPDX-License-Identifier: GPL-3.0-or-later
// The figures of an optimisation over its iterations.
#pragma once

#include <string>
#include <vector>

#include "plot/plot.hpp"

namespace vam::plot {

struct Trace {
  std::string name;  // before the names of the curves; none when empty
  std::vector<double> iteration;
  std::vector<double> ver;
  std::vector<double> window;  // relative to the largest dose
};

/// VER and process window of one run, or of two in colours of their own.
[[nodiscard]] Plot convergence(const std::vector<Trace>& traces);

}  // namespace vam::plot
