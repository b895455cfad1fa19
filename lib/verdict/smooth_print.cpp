// SPDX-License-Identifier: GPL-3.0-or-later
#include "verdict/private/smooth_print.hpp"

#include <algorithm>

#include "base/compute/parallel.hpp"
#include "base/index.hpp"
#include "model/dose/dose_metrics.hpp"
#include "verdict/print_pieces.hpp"

namespace vam::verdict {

float firm_dose(float coverage, float dose, double threshold) {
  const auto least = static_cast<float>((1 - dose_margin) * threshold);
  const auto most = static_cast<float>((1 + dose_margin) * threshold);
  if (dose < least || dose > most) return dose;
  return coverage >= static_cast<float>(model::half_surface) ? most : least;
}

float other_dose(double factor, float coverage, float dose, double threshold) {
  const float other = static_cast<float>(factor) * dose;
  const bool cures = static_cast<double>(other) >= threshold;
  const bool stays = factor < 1 ? model::label_of(coverage) == model::Label::part && !cures
                                : model::label_of(coverage) == model::Label::void_ && cures;
  return stays ? dose : other;
}

/// Along the 13 lines through the voxel and its neighbours.
bool SmoothPrint::is_thin(const Around& around, std::size_t at) const {
  const std::uint8_t is = around[reach][at];
  for (int line = 0; line < 13; ++line) {
    const int dz = line / 9 - 1;
    const std::ptrdiff_t in_slice = (line / 3 % 3 - 1) * static_cast<std::ptrdiff_t>(row_) + line % 3 - 1;
    const auto goes_on = [&](int steps) {
      return around[reach + steps * dz][static_cast<std::ptrdiff_t>(at) + steps * in_slice] == is;
    };
    const bool on = goes_on(1);
    const bool back = goes_on(-1);
    if (on && back) continue;
    if (!(on && goes_on(2)) && !(back && goes_on(-2))) return true;
  }
  return false;
}

std::vector<float> SmoothPrint::smooth(int first, int last) const {
  const std::size_t size = product(width_, height_);
  std::vector<float> smoothed(product(std::max(last - first, 0), size));
  const std::vector<std::uint8_t> beyond(product(row_, height_ + 2 * reach), 0);
  parallel_for(std::max(last - first, 0), [&](int n) {
    const Slice& slice = slices_[first + n];
    Around around{};
    for (int k = 0; k < count_of(around); ++k) {
      const int at = first + n + k - reach;
      around[k] = (at >= 0 && at < count_of(slices_) ? slices_[at].part : beyond).data();
    }
    for (int y = 0; y < height_; ++y) {
      for (int x = 0; x < width_; ++x) {
        const std::size_t i = product(y, width_) + static_cast<std::size_t>(x);
        const std::size_t at = product(y + reach, row_) + static_cast<std::size_t>(x + reach);
        const float firm = firm_dose(slice.part[at], slice.dose[i], threshold_);
        const bool stays = firm == slice.dose[i] || is_thin(around, at);
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
    Slice slice{std::vector<std::uint8_t>(product(row_, height_ + 2 * reach)),
                std::vector<float>(dose + first, dose + first + size)};
    for (int y = 0; y < height_; ++y) {
      const float* from = coverage + first + product(y, width_);
      std::uint8_t* to = slice.part.data() + product(y + reach, row_) + reach;
      for (int x = 0; x < width_; ++x) to[x] = from[x] >= static_cast<float>(model::half_surface) ? 1 : 0;
    }
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

}  // namespace vam::verdict
