// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/smooth_print.hpp"

#include <algorithm>
#include <cstddef>

#include "base/index.hpp"
#include "base/parallel.hpp"
#include "model/dose_metrics.hpp"

namespace vam::model {

namespace {

constexpr double rough = 0.02;  // of the dose
constexpr int thin = 2;         // voxels in a row
constexpr int reach = thin;     // slices beyond which nothing is looked at

}  // namespace

bool SmoothPrint::has_part(int k, int x, int y) const {
  const bool in = k >= 0 && k < count_of(slices_) && x >= 0 && x < width_ && y >= 0 && y < height_;
  return in && slices_[k].part[product(y, width_) + static_cast<std::size_t>(x)] != 0;
}

float firm_dose(float coverage, float dose, double threshold) {
  const auto least = static_cast<float>((1 - rough) * threshold);
  const auto most = static_cast<float>((1 + rough) * threshold);
  if (dose < least || dose > most) return dose;
  return coverage >= static_cast<float>(half_surface) ? most : least;
}

float other_dose(double factor, float coverage, float dose, double threshold) {
  const float other = static_cast<float>(factor) * dose;
  const bool cures = static_cast<double>(other) >= threshold;
  const bool stays =
      factor < 1 ? label_of(coverage) == Label::part && !cures : label_of(coverage) == Label::void_ && cures;
  return stays ? dose : other;
}

/// Along the 13 lines through a voxel and its neighbours.
bool SmoothPrint::is_thin(int k, int x, int y) const {
  const bool is = has_part(k, x, y);
  const auto steps = [&](int dx, int dy, int dz) {  // to its end in a direction
    int n = 1;
    while (n <= reach && has_part(k + n * dz, x + n * dx, y + n * dy) == is) ++n;
    return n;
  };
  for (int line = 0; line < 13; ++line) {
    const int dx = line % 3 - 1;
    const int dy = line / 3 % 3 - 1;
    const int dz = line / 9 - 1;
    if (steps(dx, dy, dz) + steps(-dx, -dy, -dz) <= thin + 1) return true;
  }
  return false;
}

std::vector<float> SmoothPrint::smooth(int first, int last) const {
  const std::size_t size = product(width_, height_);
  std::vector<float> smoothed(product(std::max(last - first, 0), size));
  parallel_for(std::max(last - first, 0), [&](int n) {
    const Slice& slice = slices_[first + n];
    for (int y = 0; y < height_; ++y) {
      for (int x = 0; x < width_; ++x) {
        const std::size_t i = product(y, width_) + static_cast<std::size_t>(x);
        const float firm = firm_dose(slice.part[i], slice.dose[i], threshold_);
        const bool stays = firm == slice.dose[i] || is_thin(first + n, x, y);
        smoothed[product(n, size) + i] = stays ? slice.dose[i] : firm;
      }
    }
  });
  return smoothed;
}

std::vector<float> SmoothPrint::add(int count, const float* coverage, const float* dose) {
  const std::size_t size = product(width_, height_);
  for (int n = 0; n < count; ++n) {
    const std::size_t first = product(n, size);
    Slice slice{std::vector<std::uint8_t>(size), std::vector<float>(dose + first, dose + first + size)};
    for (std::size_t i = 0; i < size; ++i)
      slice.part[i] = coverage[first + i] >= static_cast<float>(half_surface) ? 1 : 0;
    slices_.push_back(std::move(slice));
  }
  const int known = std::max(count_of(slices_) - reach, returned_);
  std::vector<float> smoothed = smooth(returned_, known);
  const int kept_from = std::max(known - reach, 0);
  slices_.erase(slices_.begin(), slices_.begin() + kept_from);
  returned_ = known - kept_from;
  return smoothed;
}

std::vector<float> SmoothPrint::rest() const { return smooth(returned_, count_of(slices_)); }

}  // namespace vam::model
