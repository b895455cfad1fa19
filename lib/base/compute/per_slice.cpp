// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/compute/per_slice.hpp"

#include <limits>

#include "base/error.hpp"

namespace vam {

std::vector<Slab> slabs(std::size_t count, int width, int height) {
  return std::vector<Slab>(count, Slab(width, height));
}

std::vector<Slab> packed(std::span<const Image> slices, int width, int height) {
  for (const Image& image : slices) {
    if (image.width != width || image.height != height) throw Error{Fault::bug, "packed: a slice of another size"};
  }
  std::vector<Slab> all = slabs((slices.size() + lanes - 1) / lanes, width, height);
  parallel_for(count_of(all) * height, [&](int item) {
    const std::size_t first = product(item / height, lanes);
    const auto some = slices.subspan(first, std::min<std::size_t>(lanes, slices.size() - first));
    const int y = item % height;
    std::array<const float*, lanes> rows{};
    for (std::size_t s = 0; s < some.size(); ++s) rows[s] = some[s].row(y);
    side_by_side(std::span(rows).first(some.size()), width, all[item / height].at(0, y), lanes);
  });
  return all;
}

PerSlice filled(std::size_t slabs, float value) {
  PerSlice result(slabs);
  for (auto& lane : result) lane.fill(value);
  return result;
}

PerSlice sum_of_rows(const PerSlice& rows, std::size_t slabs) {
  PerSlice result(slabs);
  for (std::size_t s = 0; s < slabs; ++s) {
    std::array<double, lanes> total{};
    for (std::size_t i = s * rows.size() / slabs; i < (s + 1) * rows.size() / slabs; ++i) {
      for (std::size_t lane = 0; lane < lanes; ++lane) total[lane] += static_cast<double>(rows[i][lane]);
    }
    for (std::size_t lane = 0; lane < lanes; ++lane) result[s][lane] = static_cast<float>(total[lane]);
  }
  return result;
}

PerSlice minima(std::span<const Slab> images) {
  constexpr float highest = std::numeric_limits<float>::max();
  const auto lower = [](float& a, float b) { a = std::min(a, b); };
  return reduce(
      images, highest, [&](float& a, std::size_t s, std::size_t i) { lower(a, images[s].values[i]); }, lower);
}

PerSlice largest(std::span<const Slab> images) {
  constexpr float lowest = std::numeric_limits<float>::lowest();
  return reduce(
      images, lowest, [&](float& a, std::size_t s, std::size_t i) { larger(a, images[s].values[i]); }, larger);
}

PerSlice largest_of_all(PerSlice values) {
  float most = std::numeric_limits<float>::lowest();
  for (const auto& lane : values) most = std::max(most, *std::max_element(lane.begin(), lane.end()));
  for (auto& lane : values) lane.fill(most);
  return values;
}

PerSlice reciprocal(PerSlice values) {
  for (auto& lane : values) {
    for (float& v : lane) v = v > 0 ? 1.0F / v : 0.0F;
  }
  return values;
}

void restore(std::vector<Slab>& now, const std::vector<Slab>& before, const PerSlice& back) {
  for_values(now, [&](std::size_t s, std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      if (back[s][i % lanes] != 0.0F) now[s].values[i] = before[s].values[i];
    }
  });
}

void scale(std::span<Slab> images, const PerSlice& factor) {
  for_values(images, [&](std::size_t s, std::size_t first, std::size_t last) {
    float* v = images[s].values.data();
    const float* f = factor[s].data();
    for (std::size_t i = first; i < last; i += lanes) {
      for (std::size_t lane = 0; lane < lanes; ++lane) v[i + lane] *= f[lane];
    }
  });
}

void clip_below(std::span<Slab> images, float floor) {
  for_values(images, [&](std::size_t s, std::size_t first, std::size_t last) {
    float* v = images[s].values.data();
    for (std::size_t i = first; i < last; ++i) v[i] = v[i] > floor ? v[i] : floor;
  });
}

}  // namespace vam
