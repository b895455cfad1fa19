// SPDX-License-Identifier: GPL-3.0-or-later
#include "vam-convert/resliced.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "base/index.hpp"

namespace vam::convert_tool {

Resliced::Resliced(Slices& slices, double z0_mm, double pitch_mm, const std::optional<model::Grid>& grid)
    : slices_(slices), z0_mm_(z0_mm), pitch_mm_(pitch_mm), grid_(grid) {}

bool Resliced::take() {
  Image slice;
  if (!slices_.next(slice)) return false;
  const double light = std::accumulate(slice.values.begin(), slice.values.end(), 0.0);
  const double z_mm = z0_mm_ + pitch_mm_ * (first_ + count_of(window_));
  const bool inside = z_mm >= grid_->z_mm(-0.5) && z_mm <= grid_->z_mm(grid_->nz - 0.5);
  light_ += light;
  if (!inside) beside_ += light;
  window_.push_back(std::move(slice));
  return true;
}

double Resliced::weight(int source, double place) const {
  const double span = grid_->voxel_mm / pitch_mm_;  // of a voxel, in slices
  if (span > 1) {
    const double low = std::max(place - span / 2, source - 0.5);
    const double high = std::min(place + span / 2, source + 0.5);
    return std::max(high - low, 0.0) / span;
  }
  const double last = slices_.size().images - 1;
  if (place < -0.5 || place > last + 0.5) return 0;
  return std::max(1 - std::abs(std::clamp(place, 0.0, last) - source), 0.0);
}

bool Resliced::next(Image& slice) {
  if (!grid_) return slices_.next(slice);
  if (done_ == grid_->nz) return false;
  const double place = (grid_->z_mm(done_) - z0_mm_) / pitch_mm_;
  const double half = std::max(grid_->voxel_mm / pitch_mm_ / 2, 1.0);
  while (first_ + count_of(window_) <= place + half && take()) {
  }
  while (!window_.empty() && first_ < place - half) {
    window_.pop_front();
    ++first_;
  }
  slice = Image(slices_.size().columns, slices_.size().rows);
  for (int i = 0; i < count_of(window_); ++i) {
    const auto share = static_cast<float>(weight(first_ + i, place));
    if (share == 0) continue;
    const auto& from = window_[i].values;
    for (std::size_t at = 0; at < from.size(); ++at) slice.values[at] += share * from[at];
  }
  ++done_;
  return true;
}

double Resliced::left_out() {
  if (!grid_) return 0;
  while (take()) {
    first_ += count_of(window_);
    window_.clear();
  }
  return light_ > 0 ? beside_ / light_ : 0;
}

}  // namespace vam::convert_tool
