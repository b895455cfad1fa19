// SPDX-License-Identifier: GPL-3.0-or-later
// Which voxels of a slice are of a set, as bits: 64 are looked at in one step.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "base/index.hpp"
#include "verdict/private/pieces.hpp"

namespace vam::verdict {

/// The least number that is not below the level: a value reaches the one where it reaches the other.
[[nodiscard]] float least_reaching(double level);

/// A slice with a margin of one voxel all round, in rows of whole words. Columns and rows: -1 ... width and height.
class BitSlice {
 public:
  using Word = std::uint64_t;
  static constexpr int word_bits = std::numeric_limits<Word>::digits;

  /// No voxel is of the set, or each one.
  BitSlice(int width, int height, bool all = false);
  /// Those with is(pixel), and the margin or not.
  template <class Is>
  BitSlice(int width, int height, bool margin, const Is& is) : BitSlice(width, height, margin) {
    std::vector<std::uint8_t> of_row(product(words_, word_bits), 0);
    for (int y = 0; y < height_; ++y) {
      const std::size_t first = product(y, width_);
      for (std::size_t x = 0; x < static_cast<std::size_t>(width_); ++x) of_row[x + 1] = is(first + x) ? 1 : 0;
      of_row[0] = of_row[static_cast<std::size_t>(width_) + 1] = margin ? 1 : 0;
      pack(of_row.data(), row(y));
    }
  }

  [[nodiscard]] int width() const { return width_; }
  [[nodiscard]] int height() const { return height_; }
  [[nodiscard]] int words() const { return words_; }  // of a row; at least one bit more than it has voxels
  /// Bit x + 1 is that of column x; bits beyond the margin have no meaning.
  [[nodiscard]] const Word* row(int y) const { return bits_.data() + product(y + 1, words_); }
  [[nodiscard]] Word* row(int y) { return bits_.data() + product(y + 1, words_); }
  /// Of column x and the next ones, up to word_bits of them, from the lowest bit on. Neither leaves the margin.
  [[nodiscard]] unsigned some(int x, int y, int count) const {
    const Word* const from = row(y) + (x + 1) / word_bits;
    const int shift = (x + 1) % word_bits;
    Word bits = from[0] >> shift;
    if (shift + count > word_bits) bits |= from[1] << (word_bits - shift);
    return static_cast<unsigned>(bits & ((Word{1} << count) - 1));
  }
  [[nodiscard]] bool any() const;  // in the volume

  /// Its runs of voxels that are of the set or, if `of` is false, are not; in the volume and, if asked for, the margin.
  [[nodiscard]] std::vector<VoxelRun> runs(bool of = true, bool with_margin = false) const;

 private:
  /// Bytes of 0 and 1 to words_ words.
  void pack(const std::uint8_t* bytes, Word* to) const;

  int width_, height_, words_;
  std::vector<Word> bits_;
};

/// The voxels that reach a level.
[[nodiscard]] BitSlice reaching(int width, int height, const float* slice, double level);

}  // namespace vam::verdict
