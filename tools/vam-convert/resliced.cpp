// SPDX-License-Identifier: GPL-3.0-or-later
#include "vam-convert/resliced.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "base/index.hpp"

namespace vam::convert_tool {

bool Resliced::take() {
  Image slice;
  if (!slices_.next(slice)) return false;
  const double light = std::accumulate(slice.values.begin(), slice.values.end(), 0.0);
  const double row = (front_ + count_of(window_) - first_) / step_;
  light_ += light;
  if (row < -0.5 || row > count_ - 0.5) beside_ += light;
  window_.push_back(std::move(slice));
  return true;
}

double Resliced::weight(int source, double place) const {
  if (averaged_) {
    const double low = std::max(place - step_ / 2, source - 0.5);
    const double high = std::min(place + step_ / 2, source + 0.5);
    return std::max(high - low, 0.0) / step_;
  }
  const double last = slices_.size().images - 1;
  if (place < -0.5 || place > last + 0.5) return 0;
  return std::max(1 - std::abs(std::clamp(place, 0.0, last) - source), 0.0);
}

bool Resliced::next(Image& slice) {
  if (done_ == count_) return false;
  const double place = first_ + done_ * step_;
  const double half = averaged_ ? std::max(step_ / 2, 1.0) : 1;
  while (front_ + count_of(window_) <= place + half && take()) {
  }
  while (!window_.empty() && front_ < place - half) {
    window_.pop_front();
    ++front_;
  }
  slice = Image(slices_.size().columns, slices_.size().rows);
  for (int i = 0; i < count_of(window_); ++i) {
    const auto share = static_cast<float>(weight(front_ + i, place));
    if (share == 0) continue;
    const auto& from = window_[i].values;
    for (std::size_t at = 0; at < from.size(); ++at) slice.values[at] += share * from[at];
  }
  ++done_;
  return true;
}

double Resliced::left_out() {
  while (take()) {
    front_ += count_of(window_);
    window_.clear();
  }
  return light_ > 0 ? beside_ / light_ : 0;
}

}  // namespace vam::convert_tool
