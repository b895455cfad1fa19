// SPDX-License-Identifier: GPL-3.0-or-later
// Is a stated sigma honest? Counts how often the truth lies within 2 sigma.
#pragma once

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "base/stats/measured.hpp"

namespace vam::test {

class Coverage {
 public:
  explicit Coverage(std::string name) : name_(std::move(name)) {}
  /// scale: of the error in worst().
  void add(const stats::Measured& found, double truth, double scale = 1) {
    const double error = std::abs(found.value - truth);
    worst_ = std::max(worst_, error * scale);
    ratios_.push_back(error / found.sigma);
  }
  [[nodiscard]] double worst() const { return worst_; }
  /// At least 95 % within 2 sigma, and no sigma that is safe because it is huge: half of all errors are beyond 0.3.
  void check() {
    const auto inside = std::count_if(ratios_.begin(), ratios_.end(), [](double ratio) { return ratio <= 2; });
    std::sort(ratios_.begin(), ratios_.end());
    const double part = static_cast<double>(inside) / static_cast<double>(ratios_.size());
    const double median = ratios_[ratios_.size() / 2];
    MESSAGE(name_ << ": " << 100 * part << " % of " << ratios_.size() << " within 2 sigma, median " << median
                  << " sigma, worst " << worst_);
    CHECK(part >= 0.95);
    CHECK(median > 0.3);
  }

 private:
  std::string name_;
  std::vector<double> ratios_;
  double worst_ = 0;
};

}  // namespace vam::test
