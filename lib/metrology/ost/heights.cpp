// SPDX-License-Identifier: GPL-3.0-or-later
#include "metrology/ost/private/heights.hpp"

#include <algorithm>
#include <cmath>

#include "base/compute/parallel.hpp"
#include "base/cubic.hpp"
#include "base/index.hpp"
#include "optics/skew_ray.hpp"
#include "optics/writable_radius.hpp"

namespace vam::metrology {

namespace {

double tallest_mm(const Eye& eye) { return std::max(std::abs(eye.z_mm(0)), std::abs(eye.z_mm(eye.rows - 1))); }

}  // namespace

FourTaps four_taps(double at, int size) {
  const double whole = std::floor(at);
  const auto weights = cubic_weights(static_cast<float>(at - whole));
  FourTaps taps{std::clamp(static_cast<int>(whole) - 1, 0, size - 4), {}};
  for (int j = 0; j < 4; ++j) {
    taps.weights[std::clamp(static_cast<int>(whole) + j - 1, 0, size - 1) - taps.first] += weights[j];
  }
  return taps;
}

RowOfHeight::RowOfHeight(const Eye& eye) : eye_(eye), columns_(eye.camera.columns) {
  const double high = std::max(tallest_mm(eye), 1e-3);
  const double low = 0.5 * high;
  std::vector<bool> hit(columns_.size());
  for (std::size_t c = 0; c < columns_.size(); ++c) {
    const double x = eye.camera.x_mm(static_cast<double>(c));
    const auto one = optics::skew_ray(eye.view, x, low);
    const auto two = optics::skew_ray(eye.view, x, high);
    hit[c] = one.hits && two.hits;
    if (!hit[c]) continue;
    const double cubic = (two.height_mm / high - one.height_mm / low) / (high * high - low * low);
    columns_[c] = {one.height_mm / low - cubic * low * low, cubic};
  }
  const auto first = static_cast<std::size_t>(std::find(hit.begin(), hit.end(), true) - hit.begin());
  if (first == hit.size()) {
    std::fill(columns_.begin(), columns_.end(), ColumnHeights{1, 0});
    return;
  }
  for (std::size_t c = 0; c < columns_.size(); ++c) {
    if (!hit[c]) columns_[c] = c < first ? columns_[first] : columns_[c - 1];
  }
}

double RowOfHeight::row(int column, double height_mm) const {
  const auto& [linear, cubic] = columns_[column];
  double z = height_mm / linear;
  for (int step = 0; step < 3; ++step) z -= (z * (linear + cubic * z * z) - height_mm) / (linear + 3 * cubic * z * z);
  return eye_.axis_row - z / eye_.camera.pixel_mm;
}

double climb_rate_per_mm(const Eye& eye, double x_v_mm) {
  if (!eye.view.rows_lens_mm) return 0;
  const double most = optics::reach_mm(eye.view) * (1 - 1e-3);  // beyond, as at the rim
  const double z_p = std::max(0.5 * tallest_mm(eye), 1e-3);
  const auto column = optics::column_of(eye.view, std::clamp(x_v_mm, -most, most)).value();
  const auto ray = optics::skew_ray(eye.view, column.x_p_mm, z_p);
  return ray.hits ? ray.climb / ray.height_mm : 0.0;
}

LevelRows::LevelRows(const RowOfHeight& map, int columns, int rows, std::span<const double> heights_mm,
                     const AxisPose& axis)
    : LevelRows(columns, rows, count_of(heights_mm), axis, [&](int x, int k) { return map.row(x, heights_mm[k]); }) {}

LevelRows::LevelRows(int columns, int rows, int heights, const AxisPose& axis,
                     const std::function<double(int column, int height)>& row_of)
    : columns_(columns), heights_(heights), taps_(product(columns, heights_)) {
  const double middle = 0.5 * (rows - 1);
  const double c = std::cos(axis.tilt_rad);
  const double s = std::sin(axis.tilt_rad);
  parallel_for(heights_, [&](int k) {
    for (int x = 0; x < columns; ++x) {
      const double across = x - axis.column;
      const auto row = static_cast<float>(std::clamp(row_of(x, k), 0.0, rows - 1.0));
      const double along = static_cast<double>(row) - middle;
      const FourTaps right = four_taps(axis.column + c * across + s * along, columns);
      const FourTaps down = four_taps(middle - s * across + c * along, rows);
      taps_[product(k, columns) + x] = {product(down.first, columns) + right.first, right.weights, down.weights};
    }
  });
}

Image LevelRows::of(const Image& image) const {
  using Four = float __attribute__((vector_size(16), may_alias, aligned(4)));
  Image out(columns_, heights_);
  for (std::size_t i = 0; i < taps_.size(); ++i) {
    const PixelTaps& taps = taps_[i];
    const float* from = image.values.data() + taps.first;
    Four sum{};
    for (int y = 0; y < 4; ++y, from += columns_) sum += taps.down[y] * *reinterpret_cast<const Four*>(from);
    sum *= *reinterpret_cast<const Four*>(taps.right.data());
    out.values[i] = sum[0] + sum[1] + sum[2] + sum[3];
  }
  return out;
}

std::vector<double> print_heights(const Image& mean_view, const RowOfHeight& map, const Eye& eye,
                                  const model::Grid& grid, std::size_t most) {
  constexpr double dim = 0.2;  // of the brightest row: nothing to see there
  std::vector<double> bright(mean_view.height);
  for (int y = 0; y < mean_view.height; ++y) {
    const auto [low, high] = std::minmax_element(mean_view.row(y), mean_view.row(y) + mean_view.width);
    bright[y] = static_cast<double>(*high - *low);
  }
  const double least = dim * *std::max_element(bright.begin(), bright.end());
  const int middle = std::clamp(round_int(eye.camera.axis_column), 0, eye.camera.columns - 1);
  std::vector<double> heights;
  for (int k = 0; k < grid.nz; ++k) {
    const int row = round_int(map.row(middle, grid.z_mm(k)));
    if (row >= 2 && row + 2 < mean_view.height && bright[row] >= least) heights.push_back(grid.z_mm(k));
  }
  std::sort(heights.begin(), heights.end(), [](double a, double b) { return std::abs(a) < std::abs(b); });
  heights.resize(std::min(heights.size(), most));
  std::sort(heights.begin(), heights.end());
  return heights;
}

}  // namespace vam::metrology
