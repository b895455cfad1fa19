// SPDX-License-Identifier: GPL-3.0-or-later
#include "light/rays/row_spread.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/index.hpp"

namespace vam::light {

namespace {

constexpr int steps = 256;
constexpr double of_places = 1.0 / 6;  // the mean of p (1 - p)

/// The variance of light at the place p = 0 beyond its own: the mean of |s| (1 - |s|) over chords of a disc, and of all
/// places where these reach beyond a row.
double of_rows(double sigma) {
  const double mean = 8 * sigma / (3 * std::numbers::pi);  // of |s|
  return sigma < 0.5 ? mean - sigma * sigma : of_places;
}

struct Chords {
  std::vector<double> weights;
  double sum = 1, variance = 0;

  explicit Chords(double a) : weights{1} {
    for (int k = 1; k < a; ++k) {
      const double weight = std::sqrt(1 - (k / a) * (k / a));
      weights.push_back(weight);
      sum += 2 * weight;
      variance += 2 * weight * k * k;
    }
    variance /= sum;
  }
};

std::vector<float> kernel_of(double sigma) {
  double low = 1, high = 3 * sigma + 2;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (Chords(middle).variance < sigma * sigma ? low : high) = middle;
  }
  const Chords chords(high);
  std::vector<float> weights;
  for (const double weight : chords.weights) weights.push_back(static_cast<float>(weight / chords.sum));
  return weights;
}

}  // namespace

RowSpread::RowSpread(double largest_rows) : kernels_{{1.0F}} {
  if (!(largest_rows > 0)) return;
  steps_per_row_ = steps / std::sqrt(largest_rows * largest_rows + 2 * of_places);
  for (int step = 1; step <= steps; ++step) kernels_.push_back(kernel_of(step / steps_per_row_));
}

int RowSpread::step(double rows, double read) const {
  const double variance = rows * rows + (1 - read / of_places) * of_rows(rows);
  const int step = round_int(std::sqrt(std::max(0.0, variance)) * steps_per_row_);
  return std::min(step, static_cast<int>(kernels_.size()) - 1);
}

}  // namespace vam::light
