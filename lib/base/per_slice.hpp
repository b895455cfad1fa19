// A pass: the up to 64 slices that are optimised together, 16 in a slab; and arithmetic slice by slice.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "base/parallel.hpp"
#include "base/slab.hpp"

namespace vam {

inline constexpr int slabs_per_pass = 4;
inline constexpr int slices_per_pass = slabs_per_pass * lanes;

/// One number for each slice of the pass: values[slab][lane].
using PerSlice = std::vector<std::array<float, lanes>>;

/// So many slabs of zeros.
[[nodiscard]] std::vector<Slab> slabs(std::size_t count, int width, int height);

/// work(slab, first, last): the slab's values [first, last), whole lane groups, shared among the threads.
template <class Work>
void for_values(std::span<const Slab> like, const Work& work) {
  if (like.empty()) return;
  const int rows = like[0].height;
  const std::size_t row = static_cast<std::size_t>(like[0].width) * lanes;
  parallel_for(static_cast<int>(like.size()) * rows, [&](int i) {
    const std::size_t first = static_cast<std::size_t>(i % rows) * row;
    work(static_cast<std::size_t>(i / rows), first, first + row);
  });
}

/// Reduces the rows of each slab: fold(accumulator of 16 lanes, slab, first, last), then merges rows in order.
template <class Fold, class Merge>
[[nodiscard]] PerSlice reduce(std::span<const Slab> images, float start, const Fold& fold, const Merge& merge) {
  PerSlice result(images.size());
  for (auto& lane : result) lane.fill(start);
  if (images.empty()) return result;
  const auto rows = static_cast<std::size_t>(images[0].height);
  const std::size_t row = static_cast<std::size_t>(images[0].width) * lanes;
  std::vector<std::array<float, lanes>> partial(images.size() * rows);
  for_values(images, [&](std::size_t s, std::size_t first, std::size_t last) {
    std::array<float, lanes> sum{};
    sum.fill(start);
    for (std::size_t i = first; i < last; i += lanes) {
      for (std::size_t lane = 0; lane < lanes; ++lane) fold(sum[lane], s, i + lane);
    }
    partial[s * rows + first / row] = sum;
  });
  for (std::size_t i = 0; i < partial.size(); ++i) {
    for (std::size_t lane = 0; lane < lanes; ++lane) merge(result[i / rows][lane], partial[i][lane]);
  }
  return result;
}

/// Sum over each slice of value(slab, index), the rows of a slice added in order.
template <class Value>
[[nodiscard]] PerSlice summed(std::span<const Slab> like, const Value& value) {
  PerSlice result(like.size());
  for (auto& lane : result) lane.fill(0.0F);
  if (like.empty()) return result;
  const auto rows = static_cast<std::size_t>(like[0].height);
  const std::size_t row = static_cast<std::size_t>(like[0].width) * lanes;
  std::vector<std::array<float, lanes>> partial(like.size() * rows);
  for_values(like, [&](std::size_t s, std::size_t first, std::size_t last) {
    std::array<float, lanes> sum{};
    for (std::size_t i = first; i < last; i += lanes) {
      for (std::size_t lane = 0; lane < lanes; ++lane) sum[lane] += value(s, i + lane);
    }
    partial[s * rows + first / row] = sum;
  });
  std::vector<std::array<double, lanes>> totals(like.size());
  for (std::size_t i = 0; i < partial.size(); ++i) {
    for (std::size_t lane = 0; lane < lanes; ++lane) totals[i / rows][lane] += static_cast<double>(partial[i][lane]);
  }
  for (std::size_t s = 0; s < totals.size(); ++s) {
    for (std::size_t lane = 0; lane < lanes; ++lane) result[s][lane] = static_cast<float>(totals[s][lane]);
  }
  return result;
}

/// a = max(a, b), for reduce.
inline constexpr auto larger = [](float& a, float b) { a = std::max(a, b); };

/// 1 / value, 0 for 0.
[[nodiscard]] PerSlice reciprocal(PerSlice values);
/// now = before for the slices whose `back` is not 0.
void restore(std::vector<Slab>& now, const std::vector<Slab>& before, const PerSlice& back);

/// Smallest value of each slice.
[[nodiscard]] PerSlice minima(std::span<const Slab> images);
/// Largest value of each slice.
[[nodiscard]] PerSlice largest(std::span<const Slab> images);
/// images[slice] *= factor[slice].
void scale(std::span<Slab> images, const PerSlice& factor);
/// images = max(images, floor).
void clip_below(std::span<Slab> images, float floor);

}  // namespace vam
