// SPDX-License-Identifier: GPL-3.0-or-later
#include "score/cured_pieces.hpp"

#include "base/index.hpp"
#include "base/parallel.hpp"
#include "model/dose_metrics.hpp"

namespace vam::score {

CuredPieces::CuredPieces(const model::Circle& circle, double threshold, int width, int height)
    : counter_(width, height, threshold) {
  inside_.reserve(product(width, height));
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) inside_.push_back(circle.contains(x, y));
  }
}

void CuredPieces::add(const float* dose, const float* target, int count) {
  std::vector<float> judged(product(count, inside_.size()), 0.0F);
  parallel_for(count, [&](int s) {
    const std::size_t first = product(s, inside_.size());
    for (std::size_t i = 0; i < inside_.size(); ++i) {
      if (inside_[i] || target[first + i] >= static_cast<float>(model::half_surface))
        judged[first + i] = dose[first + i];
    }
  });
  counter_.add(count, target, judged.data());
}

}  // namespace vam::score
