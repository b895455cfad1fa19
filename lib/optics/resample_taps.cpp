// SPDX-License-Identifier: GPL-3.0-or-later
#include "optics/private/resample_taps.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/cubic.hpp"
#include "base/index.hpp"

namespace vam::optics {

namespace {

// Input columns: a kernel so wide has its moments unhelped, to a float's precision.
constexpr double smooth = 4096;

double kernel(Interpolation interpolation, double x) {
  return interpolation == Interpolation::linear ? std::max(0.0, 1.0 - std::abs(x)) : cubic_kernel(x);
}

// Taps around `column` of the kernel stretched to `width` >= 1 input columns. Sampled between its knots a stretched
// kernel no longer reproduces polynomials; the smallest change b(d) (p + q d + r d^2) under a positive bump b restores
// its order, that is the moments 1, 0 of the tent and 1, 0, 0 of the cubic (d = distance / width).
std::vector<double> kernel_taps(Interpolation interpolation, double column, double width, int first, int last) {
  const int order = interpolation == Interpolation::linear ? 2 : 3;
  const double half = order - 1;
  const auto bump = [&](double d) { return (1 - d / half) * (1 + d / half); };
  std::vector<double> taps;
  for (int c = first; c <= last; ++c) taps.push_back(kernel(interpolation, (c - column) / width) / width);
  if (width == 1.0 || width >= smooth) return taps;
  double system[3][4] = {{0, 0, 0, 1}, {}, {}};  // moments of the bump; what the kernel's moments lack
  for (int c = first; c <= last; ++c) {
    const double d = (c - column) / width;
    for (int i = 0; i < order; ++i) {
      for (int j = 0; j < order; ++j) system[i][j] += bump(d) * std::pow(d, i + j);
      system[i][3] -= taps[c - first] * std::pow(d, i);
    }
  }
  for (int i = 0; i < order; ++i) {  // Gauss without pivoting: a Gram matrix is positive definite
    for (int below = i + 1; below < order; ++below) {
      const double ratio = system[below][i] / system[i][i];
      for (int j = i; j < 4; ++j) system[below][j] -= ratio * system[i][j];
    }
  }
  double factor[3] = {};
  for (int i = order - 1; i >= 0; --i) {
    factor[i] = system[i][3];
    for (int j = i + 1; j < order; ++j) factor[i] -= system[i][j] * factor[j];
    factor[i] /= system[i][i];
  }
  for (int c = first; c <= last; ++c) {
    const double d = (c - column) / width;
    taps[c - first] += bump(d) * (factor[0] + d * (factor[1] + d * factor[2]));
  }
  return taps;
}

}  // namespace

void add_source(ResamplePlan& plan, Interpolation interpolation, double column, double width, double row,
                double weight) {
  ColumnSource source;
  const double half = (interpolation == Interpolation::linear ? 1.0 : 2.0) * width;
  // The moments are those of the whole kernel; without need of them it ends where the input does.
  const double beyond = width < smooth ? half : 0;
  const int first = floor_int(std::max(column - half, -1 - beyond)) + 1;
  const int last = ceil_int(std::min(column + half, plan.columns_in + beyond)) - 1;
  const std::vector<double> taps = kernel_taps(interpolation, column, width, first, last);
  source.first = std::max(first, 0);
  source.count = std::max(0, std::min(last, plan.columns_in - 1) - source.first + 1);
  source.weights = plan.weights.size();
  const double* inside = taps.data() + (source.first - first);
  for (int k = 0; k < source.count; ++k) plan.weights.push_back(static_cast<float>(weight * inside[k]));
  // Output row a wants input position row + sense * a: four taps around it, the first one row below.
  const double below = std::floor(row);
  const double part = row - below;
  for (int j = 0; j < 4; ++j) source.angle_weights[j] = static_cast<float>(kernel(interpolation, part + 1 - j));
  source.row = static_cast<int>(std::fmod(below - 1, plan.rows));
  if (source.row < 0) source.row += plan.rows;
  plan.sources.push_back(source);
}

}  // namespace vam::optics
