// SPDX-License-Identifier: GPL-3.0-or-later
#include "resin/curethrough/part_columns.hpp"

#include <algorithm>
#include <bit>

#include "base/compute/parallel.hpp"
#include "base/index.hpp"

namespace vam::resin {

namespace {

constexpr std::uint64_t all_ones = ~std::uint64_t{0};
constexpr int word_bits = 64;

std::uint64_t low_bits(int count) { return count >= word_bits ? all_ones : (std::uint64_t{1} << count) - 1; }

void set(std::uint64_t& word, std::uint64_t mask, std::uint64_t bits) { word = (word & ~mask) | (bits & mask); }

}  // namespace

PartColumns::PartColumns(int width, int height, int slices, ExposureMode exposure)
    : width_(width),
      height_(height),
      slices_(slices),
      nodes_(exposure == ExposureMode::continuous ? slices + 1 : slices),
      planes_(exposure == ExposureMode::continuous),
      pixels_(product(width, height)),
      stride_(static_cast<std::size_t>(nodes_ + 63) / 64),
      words_(pixels_ * stride_) {}

void PartColumns::put(std::size_t column, int first, int count, std::uint64_t bits) {
  std::uint64_t* word = words_.data() + column * stride_ + first / word_bits;
  const int shift = first % word_bits;
  const std::uint64_t mask = low_bits(count);
  set(word[0], mask << shift, bits << shift);
  if (shift + count > word_bits) set(word[1], mask >> (word_bits - shift), bits >> (word_bits - shift));
}

void PartColumns::fill(std::size_t column, int first, int count, bool solid) {
  for (int done = 0; done < count; done += word_bits) {
    put(column, first + done, std::min(word_bits, count - done), solid ? all_ones : 0);
  }
}

// The 64 slices from `first` on; 0 beyond the last.
std::uint64_t PartColumns::bits(std::size_t column, int first) const {
  const std::uint64_t* words = column_words(column);
  const auto index = static_cast<std::size_t>(first / word_bits);
  const int shift = first % word_bits;
  const std::uint64_t low = words[index] >> shift;
  return shift == 0 || index + 1 == stride_ ? low : low | words[index + 1] << (word_bits - shift);
}

void PartColumns::unpack_row(int y, int first, int count, float* out, std::size_t stride) const {
  std::vector<std::uint64_t> row(width_);
  const std::size_t start = product(y, row.size());
  for (int done = 0; done < count; done += word_bits) {
    for (std::size_t x = 0; x < row.size(); ++x) row[x] = bits(start + x, first + done);
    for (int k = 0; k < std::min(word_bits, count - done); ++k) {
      float* slice = out + static_cast<std::size_t>(done + k) * stride;
      for (std::size_t x = 0; x < row.size(); ++x) slice[x] = static_cast<float>(row[x] >> k & 1U);
    }
  }
}

void PartColumns::unpack(int first, int count, float* out) const {
  parallel_for(height_, [&](int y) { unpack_row(y, first, count, out + product(y, width_), pixels_); });
}

// A plane belongs to a feature when the slice before or after it does.
std::uint64_t PartColumns::node_word(const std::uint64_t* words, std::size_t index) const {
  const std::uint64_t here = words[index];
  if (!planes_) return here;
  const std::uint64_t carried = index > 0 ? words[index - 1] >> 63U : 0;
  return here | here << 1U | carried;
}

NodeRun PartColumns::run(std::size_t column, int node) const {
  const std::uint64_t* words = column_words(column);
  const auto home = static_cast<std::size_t>(node / 64);
  const auto bit = static_cast<unsigned>(node % 64);
  const bool inside = (node_word(words, home) >> bit & 1U) != 0;
  const std::uint64_t flip = inside ? all_ones : 0;  // after xor, a set bit differs from this node

  std::uint64_t differs = (node_word(words, home) ^ flip) & (all_ones << bit);
  std::size_t index = home;
  while (differs == 0 && ++index < stride_) differs = node_word(words, index) ^ flip;
  const int last =
      differs == 0 ? nodes_ - 1 : std::min(nodes_, static_cast<int>(index * 64) + std::countr_zero(differs)) - 1;

  differs = (node_word(words, home) ^ flip) & ~(all_ones << bit);
  index = home;
  while (differs == 0 && index-- > 0) differs = node_word(words, index) ^ flip;
  const int first = differs == 0 ? 0 : static_cast<int>(index * 64) + 64 - std::countl_zero(differs);
  return {first, last, inside};
}

int PartColumns::next_slice(std::size_t column, int n, bool solid) const {
  if (n >= slices_) return slices_;
  const std::uint64_t* words = column_words(column);
  const std::uint64_t flip = solid ? 0 : all_ones;
  auto index = static_cast<std::size_t>(n / 64);
  std::uint64_t found = (words[index] ^ flip) & (all_ones << static_cast<unsigned>(n % 64));
  while (found == 0 && ++index < stride_) found = words[index] ^ flip;
  return found == 0 ? slices_ : std::min(slices_, static_cast<int>(index * 64) + std::countr_zero(found));
}

PartSurvey survey(const PartColumns& part) {
  std::vector<PartSurvey> rows(part.height());
  parallel_for(part.height(), [&](int y) {
    PartSurvey& row = rows[y];
    const std::size_t start = product(y, part.width());
    for (std::size_t p = start; p < start + part.width(); ++p) {
      int begin = part.next_slice(p, 0, true);
      if (begin < part.slices()) ++row.columns;
      while (begin < part.slices()) {
        const int end = part.next_slice(p, begin, false);
        ++row.features;
        row.last_slice = std::max(row.last_slice, end - 1);
        begin = part.next_slice(p, end, true);
      }
    }
  });
  PartSurvey sum;
  for (const PartSurvey& row : rows) {
    sum.columns += row.columns;
    sum.features += row.features;
    sum.last_slice = std::max(sum.last_slice, row.last_slice);
  }
  return sum;
}

}  // namespace vam::resin
