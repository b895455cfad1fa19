// SPDX-License-Identifier: GPL-3.0-or-later
#include "metrology/ost/private/camera_sinograms.hpp"

#include <algorithm>

#include "base/compute/parallel.hpp"
#include "base/index.hpp"

namespace vam::metrology {

std::vector<Image> level_views(std::span<const CameraView> views, const LevelRows& rows) {
  std::vector<Image> level(views.size());
  parallel_for(count_of(views), [&](int i) { level[i] = rows.of(views[i].image); });
  return level;
}

void make_steady(std::vector<Image>& level, double background, std::span<const double> intensity) {
  if (background == 0 && intensity.empty()) return;
  const auto ground = static_cast<float>(background);
  parallel_for(count_of(level), [&](int i) {
    const float factor = intensity.empty() ? 1.0F : static_cast<float>(1 / intensity[i]);
    for (float& v : level[i].values) v = (v - ground) * factor;
  });
}

void undo_motion(std::vector<Image>& level, std::span<const ColumnMotion> motion, double axis_column) {
  parallel_for(count_of(level), [&](int i) {
    if (motion[i].shift_px == 0 && motion[i].stretch == 0) return;
    Image& image = level[i];
    std::vector<FourTaps> taps;
    for (int x = 0; x < image.width; ++x) taps.push_back(four_taps(x + motion[i].at(x - axis_column), image.width));
    std::vector<float> from(image.width);
    for (int k = 0; k < image.height; ++k) {
      float* to = image.row(k);
      std::copy(to, to + image.width, from.begin());
      for (int x = 0; x < image.width; ++x) {
        float sum = 0;
        for (int j = 0; j < 4; ++j) sum += taps[x].weights[j] * from[taps[x].first + j];
        to[x] = sum;
      }
    }
  });
}

namespace {

void add_angle(std::span<const Image> level, const Turns::Turn& turn, int angle, int height, float* out) {
  for (const auto& tap : turn.grid.taps(angle)) {
    const float* in = level[turn.first + tap.frame].row(height);
    for (int x = 0; x < level.front().width; ++x) out[x] += tap.weight * in[x];
  }
}

// Median; of an even number the mean of the two in the middle, as the upper one is too bright by a part of the noise.
float middle(std::vector<float>& values) {
  const auto upper = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), upper, values.end());
  if (values.size() % 2 != 0) return *upper;
  return 0.5F * (*upper + *std::max_element(values.begin(), upper));
}

}  // namespace

std::vector<Image> camera_sinograms(std::span<const Image> level, const Turns& turns) {
  const int columns = level.front().width;
  const std::size_t count = turns.all().size();
  std::vector<Image> sinograms(level.front().height);
  parallel_for(count_of(sinograms), [&](int k) {
    Image& sinogram = sinograms[k];
    sinogram = Image(columns, turns.angles());
    if (count == 1) {
      for (int a = 0; a < sinogram.height; ++a) add_angle(level, turns.all().front(), a, k, sinogram.row(a));
      return;
    }
    Image of_turns(columns, count_of(turns.all()));
    std::vector<float> values(count);
    for (int a = 0; a < sinogram.height; ++a) {
      std::fill(of_turns.values.begin(), of_turns.values.end(), 0.0F);
      for (int t = 0; t < of_turns.height; ++t) add_angle(level, turns.all()[t], a, k, of_turns.row(t));
      for (int x = 0; x < columns; ++x) {
        for (int t = 0; t < of_turns.height; ++t) values[t] = of_turns(x, t);
        sinogram(x, a) = middle(values);
      }
    }
  });
  return sinograms;
}

}  // namespace vam::metrology
