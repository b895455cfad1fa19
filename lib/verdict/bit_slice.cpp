// SPDX-License-Identifier: GPL-3.0-or-later
#include "verdict/private/bit_slice.hpp"

#include <bit>
#include <cmath>
#include <cstring>

namespace vam::verdict {

namespace {

using Word = BitSlice::Word;

/// The first bit from `from` on that is `of`; `end` if there is none before.
int next(const Word* words, int from, int end, bool of) {
  int at = from / BitSlice::word_bits;
  const auto word = [&] { return of ? words[at] : ~words[at]; };
  if (from >= end) return end;
  Word found = word() & (~Word{0} << (from % BitSlice::word_bits));
  while (found == 0) {
    if (++at * BitSlice::word_bits >= end) return end;
    found = word();
  }
  return std::min(at * BitSlice::word_bits + std::countr_zero(found), end);
}

}  // namespace

float least_reaching(double level) {
  const auto near = static_cast<float>(level);
  return static_cast<double>(near) >= level ? near : std::nextafter(near, std::numeric_limits<float>::infinity());
}

BitSlice::BitSlice(int width, int height, bool all)
    : width_(width),
      height_(height),
      words_((width + 2) / word_bits + 1),
      bits_(product(words_, height + 2), all ? ~Word{0} : 0) {}

void BitSlice::pack(const std::uint8_t* bytes, Word* to) const {
  static_assert(std::endian::native == std::endian::little);
  for (int n = 0; n < words_; ++n) {
    Word word = 0;
    for (int part = 0; part < 8; ++part, bytes += 8) {
      Word eight = 0;
      std::memcpy(&eight, bytes, sizeof eight);
      // The factor brings the lowest bit of byte i to bit 56 + i, and no two to one bit.
      word |= (eight * 0x0102040810204080U >> 56U) << (8 * part);
    }
    to[n] = word;
  }
}

bool BitSlice::any() const {
  for (int y = 0; y < height_; ++y) {
    if (next(row(y), 1, width_ + 1, true) <= width_) return true;
  }
  return false;
}

std::vector<VoxelRun> BitSlice::runs(bool of, bool with_margin) const {
  std::vector<VoxelRun> found;
  const int margin = with_margin ? 1 : 0;
  const int end = width_ + 1 + margin;  // as bits
  for (int y = -margin; y < height_ + margin; ++y) {
    int begin = next(row(y), 1 - margin, end, of);
    while (begin < end) {
      const int stop = next(row(y), begin, end, !of);
      found.push_back({y, begin - 1, stop - 1});
      begin = next(row(y), stop, end, of);
    }
  }
  return found;
}

BitSlice reaching(int width, int height, const float* slice, double level) {
  const float least = least_reaching(level);
  return {width, height, false, [&](std::size_t pixel) { return slice[pixel] >= least; }};
}

}  // namespace vam::verdict
