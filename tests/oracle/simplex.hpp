// SPDX-License-Identifier: GPL-3.0-or-later
// A small dense linear program solver: two-phase simplex with Bland's rule. For tests only; nothing is tuned.
#pragma once

#include <optional>
#include <vector>

namespace vam::oracle {

/// Minimise cost . x subject to a x <= b (row by row), x >= 0.
struct LinearProgram {
  std::vector<double> cost;
  std::vector<std::vector<double>> a;
  std::vector<double> b;
};

struct Optimum {
  std::vector<double> x;
  double value = 0;
};

/// Nothing when no x is feasible. Throws std::runtime_error when the program is unbounded.
std::optional<Optimum> minimise(const LinearProgram& program);

}  // namespace vam::oracle
