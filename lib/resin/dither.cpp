// SPDX-License-Identifier: GPL-3.0-or-later
#include "resin/dither.hpp"

#include <algorithm>

#include "base/index.hpp"

namespace vam::resin {

Dither::Dither(const GreyLevels& levels, int turns) : turns_(std::max(1, turns)) {
  for (int level = 0; level < levels.count(); ++level) {
    const float intensity = levels.intensity(level);
    if (!intensity_.empty() && !(intensity > intensity_.back())) continue;
    levels_.push_back(level);
    intensity_.push_back(intensity);
  }
}

int Dither::nearest(float wanted) const {
  if (!(wanted > intensity_.front()) || intensity_.size() < 2) return 0;
  const auto above = std::upper_bound(intensity_.begin() + 1, intensity_.end() - 1, wanted);
  const auto j = static_cast<int>(above - intensity_.begin()) - 1;
  const float share = std::min((wanted - intensity_[j]) / (*above - intensity_[j]), 1.0F);
  return j * turns_ + round_int(share * static_cast<float>(turns_));
}

float Dither::intensity(int step) const {
  const int j = step / turns_;
  const int more = step % turns_;
  if (more == 0) return intensity_[j];
  const float share = static_cast<float>(more) / static_cast<float>(turns_);
  return intensity_[j] + share * (intensity_[j + 1] - intensity_[j]);
}

int Dither::level(int step, int turn, int phase) const {
  const int j = step / turns_;
  const int more = step % turns_;
  const int t = (turn + phase) % turns_;
  return levels_[j + (t + 1) * more / turns_ - t * more / turns_];
}

void Dither::row(std::span<const float> wanted, bool backwards, std::span<float> carried, std::span<int> steps) const {
  constexpr float most = 0.5F;  // what the projector cannot show at all must not be saved up
  const auto width = count_of(wanted);
  const int way = backwards ? -1 : 1;
  std::vector<float> left(wanted.size() + 2, 0.0F);  // one more column at either end
  float ahead = 0;
  for (int n = 0, c = backwards ? width - 1 : 0; n < width; ++n, c += way) {
    steps[c] = 0;
    if (wanted[c] > 0) {
      const float now = wanted[c] + carried[c] + ahead;
      steps[c] = nearest(now);
      const float error = std::clamp(now - intensity(steps[c]), -most, most);
      ahead = error * 7 / 16;
      left[c + 1 - way] += error * 3 / 16;
      left[c + 1] += error * 5 / 16;
      left[c + 1 + way] += error / 16;
    } else {
      ahead = 0;
    }
  }
  std::copy_n(left.begin() + 1, width, carried.begin());
}

Image dithered(const Image& sinogram, const Dither& dither) {
  Image shown(sinogram.width, sinogram.height);
  std::vector<float> carried(sinogram.width, 0.0F);
  std::vector<int> steps(carried.size());
  for (int a = 0; a < sinogram.height; ++a) {
    dither.row({sinogram.row(a), carried.size()}, a % 2 == 1, carried, steps);
    std::transform(steps.begin(), steps.end(), shown.row(a), [&](int step) { return dither.intensity(step); });
  }
  return shown;
}

}  // namespace vam::resin
