// SPDX-License-Identifier: GPL-3.0-or-later
#include "score/cured_pieces.hpp"

#include <cstdint>

#include "base/index.hpp"
#include "base/parallel.hpp"
#include "model/dose_metrics.hpp"

namespace vam::score {

CuredPieces::CuredPieces(const model::Circle& circle, double threshold, int width, int height)
    : threshold_(threshold), counter_(width, height) {
  inside_.reserve(product(width, height));
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) inside_.push_back(circle.contains(x, y));
  }
}

void CuredPieces::add(const float* dose, const float* target, int count) {
  std::vector<std::vector<std::uint8_t>> slices(count, std::vector<std::uint8_t>(inside_.size()));
  parallel_for(count, [&](int s) {
    const std::size_t first = product(s, inside_.size());
    for (std::size_t i = 0; i < inside_.size(); ++i) {
      const float covered = target[first + i];
      const bool judged = inside_[i] || covered >= static_cast<float>(model::half_surface);
      slices[s][i] = model::printed_bits(covered, judged && static_cast<double>(dose[first + i]) >= threshold_);
    }
  });
  counter_.add(slices);
}

}  // namespace vam::score
