// SPDX-License-Identifier: GPL-3.0-or-later
#include "optimize/target/surface_band.hpp"

#include <algorithm>
#include <utility>

#include "base/compute/parallel.hpp"
#include "base/index.hpp"

namespace vam::optimize {

namespace {
constexpr float half = 0.5F;
constexpr float far_away = 1e9F;
}  // namespace

SurfaceBand::SurfaceBand(Read read, int slices, int width, int height, double reach_px)
    : read_(std::move(read)), slices_(slices), width_(width), height_(height), reach_(reach_px + 0.5) {}

/// Along x by two sweeps, then the least sum of squares over the rows within reach.
SurfaceBand::Distances SurfaceBand::to_kind(const std::vector<float>& slice, bool part) const {
  const auto width = static_cast<std::size_t>(width_);
  Distances along(slice.size());
  Distances across(slice.size(), far_away);
  parallel_for(height_, [&](int y) {
    const float* from = slice.data() + product(y, width);
    float* row = along.data() + product(y, width);
    const auto sweep = [&](auto begin, auto end, int step) {
      float d = far_away;
      for (auto x = begin; x != end; x += step) {
        d = (from[x] >= half) == part ? 0.0F : d + 1.0F;
        row[x] = std::min(row[x], d * d);
      }
    };
    std::fill_n(row, width, far_away);
    sweep(0, width_, 1);
    sweep(width_ - 1, -1, -1);
  });
  const int reach = static_cast<int>(reach_);
  parallel_for(height_, [&](int y) {
    float* to = across.data() + product(y, width);
    for (int dy = std::max(-reach, -y); dy <= std::min(reach, height_ - 1 - y); ++dy) {
      const float* row = along.data() + static_cast<std::size_t>(y + dy) * width;
      const auto rise = static_cast<float>(dy * dy);
      for (std::size_t x = 0; x < width; ++x) to[x] = std::min(to[x], row[x] + rise);
    }
  });
  return across;
}

void SurfaceBand::clear(int k, float* values) const {
  const std::size_t pixels = product(width_, height_);
  const int reach = static_cast<int>(reach_);
  std::vector<float> here(pixels);
  std::vector<float> slice(pixels);
  read_(k, 1, here.data());
  const auto limit = static_cast<float>(reach_ * reach_ + 1e-6);
  for (int dz = std::max(-reach, -k); dz <= std::min(reach, slices_ - 1 - k); ++dz) {
    read_(k + dz, 1, slice.data());
    const auto rise = static_cast<float>(dz * dz);
    for (const bool part : {true, false}) {
      const Distances distance = to_kind(slice, part);
      for (std::size_t i = 0; i < pixels; ++i) {
        if ((here[i] >= half) != part && distance[i] + rise <= limit) values[i] = 0.0F;
      }
    }
  }
}

}  // namespace vam::optimize
