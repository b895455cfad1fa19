// SPDX-License-Identifier: GPL-3.0-or-later
// A pass, the slices that are optimised together: up to four slabs (64 slices), or the whole grid where light couples
// slices; and arithmetic slice by slice.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "base/compute/parallel.hpp"
#include "base/compute/slab.hpp"
#include "base/image.hpp"
#include "base/index.hpp"

namespace vam {

inline constexpr int slabs_per_pass = 4;
inline constexpr int slices_per_pass = slabs_per_pass * lanes;

/// One number for each slice of the pass: values[slab][lane].
using PerSlice = std::vector<std::array<float, lanes>>;

/// So many slabs of zeros.
[[nodiscard]] std::vector<Slab> slabs(std::size_t count, int width, int height);

/// As many slabs as slices of width x height take, 16 in each. Throws Fault::bug for a slice of another size.
[[nodiscard]] std::vector<Slab> packed(std::span<const Image> slices, int width, int height);

/// work(slab, first, last): the slab's values [first, last), whole lane groups, shared among the threads.
template <class Work>
void for_values(std::span<const Slab> like, const Work& work) {
  if (like.empty()) return;
  const int rows = like[0].height;
  const std::size_t row = static_cast<std::size_t>(like[0].width) * lanes;
  parallel_for(count_of(like) * rows, [&](int i) {
    const std::size_t first = static_cast<std::size_t>(i % rows) * row;
    work(i / rows, first, first + row);
  });
}

/// `value` for every slice of so many slabs.
[[nodiscard]] PerSlice filled(std::size_t slabs, float value);

/// work(slab, lane) for each slice.
template <class Work>
void for_slices(const PerSlice& like, const Work& work) {
  for (std::size_t s = 0; s < like.size(); ++s) {
    for (std::size_t lane = 0; lane < lanes; ++lane) work(s, lane);
  }
}

/// The sums of fold_rows() of each slab, added in order, in double.
[[nodiscard]] PerSlice sum_of_rows(const PerSlice& rows, std::size_t slabs);

/// Folds each row of each slab into 16 accumulators: fold(accumulator, slab, index). The result has the rows of the
/// first slab, then those of the second.
template <class Fold>
[[nodiscard]] PerSlice fold_rows(std::span<const Slab> images, float start, const Fold& fold) {
  if (images.empty()) return {};
  const auto rows = static_cast<std::size_t>(images[0].height);
  const std::size_t row = static_cast<std::size_t>(images[0].width) * lanes;
  PerSlice folded = filled(images.size() * rows, start);
  for_values(images, [&](std::size_t s, std::size_t first, std::size_t last) {
    std::array<float, lanes> sum{};
    sum.fill(start);
    for (std::size_t i = first; i < last; i += lanes) {
      for (std::size_t lane = 0; lane < lanes; ++lane) fold(sum[lane], s, i + lane);
    }
    folded[s * rows + first / row] = sum;
  });
  return folded;
}

/// Reduces each slice: fold(accumulator, slab, index) along its rows, then merge(accumulator, row's) row after row.
template <class Fold, class Merge>
[[nodiscard]] PerSlice reduce(std::span<const Slab> images, float start, const Fold& fold, const Merge& merge) {
  const PerSlice rows = fold_rows(images, start, fold);
  PerSlice result = filled(images.size(), start);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    for (std::size_t lane = 0; lane < lanes; ++lane)
      merge(result[i * images.size() / rows.size()][lane], rows[i][lane]);
  }
  return result;
}

/// Sum over each slice of value(slab, index), the rows of a slice added in order, in double.
template <class Value>
[[nodiscard]] PerSlice summed(std::span<const Slab> images, const Value& value) {
  const PerSlice rows = fold_rows(images, 0, [&](float& sum, std::size_t s, std::size_t i) { sum += value(s, i); });
  return sum_of_rows(rows, images.size());
}

/// Of all slices.
template <class Value>
[[nodiscard]] double total(std::span<const Slab> images, const Value& value) {
  double sum = 0;
  for (const auto& lane : summed(images, value)) {
    for (const float part : lane) sum += static_cast<double>(part);
  }
  return sum;
}

/// images[slab].values[index] = value(slab, index).
template <class Value>
void fill(std::span<Slab> images, const Value& value) {
  for_values(images, [&](std::size_t s, std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) images[s].values[i] = value(s, i);
  });
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
/// The largest of all slices' values, for each of them.
[[nodiscard]] PerSlice largest_of_all(PerSlice values);
/// images[slice] *= factor[slice].
void scale(std::span<Slab> images, const PerSlice& factor);
/// images = max(images, floor).
void clip_below(std::span<Slab> images, float floor);

}  // namespace vam
