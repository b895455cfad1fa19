// SPDX-License-Identifier: GPL-3.0-or-later
#include "optimize/run/prolongation.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/index.hpp"

namespace vam::optimize {

Prolongation::Prolongation(std::vector<Image> coarse, const StackSamples& from, const StackSamples& to)
    : coarse_(std::move(coarse)),
      columns_(sample_weights(from.columns, to.columns, false)),
      angles_(sample_weights(from.angles, to.angles, true)),
      slices_(sample_weights(from.slices, to.slices, false)) {}

std::vector<Prolongation::SampleWeights> Prolongation::sample_weights(const Samples& from, const Samples& to,
                                                                      bool periodic) {
  std::vector<SampleWeights> all;
  all.reserve(to.count);
  for (int n = 0; n < to.count; ++n) {
    const double at = (to.first + n * to.step - from.first) / from.step;
    const double below = std::floor(at);
    const auto sample = [&](double i) {
      if (!periodic) return static_cast<int>(std::clamp(i, 0.0, from.count - 1.0));
      return static_cast<int>(i - from.count * std::floor(i / from.count));
    };
    all.push_back({sample(below), sample(below + 1), static_cast<float>(at - below)});
  }
  return all;
}

Image Prolongation::operator()(int k) const {
  const SampleWeights& slice = slices_[k];
  const Image& below = coarse_[slice.first];
  const Image& above = coarse_[slice.second];
  Image image(count_of(columns_), count_of(angles_));
  std::vector<float> row(below.width);
  float* to = image.values.data();
  for (const SampleWeights& angle : angles_) {
    const auto mixed = [](float a, float b, float weight) { return a + weight * (b - a); };
    for (std::size_t c = 0; c < row.size(); ++c) {
      const float first = mixed(below.row(angle.first)[c], above.row(angle.first)[c], slice.weight);
      const float second = mixed(below.row(angle.second)[c], above.row(angle.second)[c], slice.weight);
      row[c] = mixed(first, second, angle.weight);
    }
    for (const SampleWeights& column : columns_) {
      *to++ = mixed(row[column.first], row[column.second], column.weight);
    }
  }
  return image;
}

}  // namespace vam::optimize
