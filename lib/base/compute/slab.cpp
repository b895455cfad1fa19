// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/compute/slab.hpp"

#include <algorithm>
#include <array>

#include "base/compute/parallel.hpp"
#include "base/index.hpp"

namespace vam {

namespace {

// 4 x 4 values are turned in registers: one by one, as each is written to a line of its own, they take four times as
// long.
using Four = float __attribute__((vector_size(16), may_alias, aligned(4)));

Four load(const float* from) { return *reinterpret_cast<const Four*>(from); }
void store(float* to, Four value) { *reinterpret_cast<Four*>(to) = value; }

struct Square {
  Four row[4];
};

Square turned(const Square& in) {
  const Four a = __builtin_shufflevector(in.row[0], in.row[1], 0, 4, 1, 5);
  const Four b = __builtin_shufflevector(in.row[2], in.row[3], 0, 4, 1, 5);
  const Four c = __builtin_shufflevector(in.row[0], in.row[1], 2, 6, 3, 7);
  const Four d = __builtin_shufflevector(in.row[2], in.row[3], 2, 6, 3, 7);
  return {{__builtin_shufflevector(a, b, 0, 1, 4, 5), __builtin_shufflevector(a, b, 2, 3, 6, 7),
           __builtin_shufflevector(c, d, 0, 1, 4, 5), __builtin_shufflevector(c, d, 2, 3, 6, 7)}};
}

constexpr int block = 4096;  // pixels a work item: 256 KiB of slab

template <class Work>
void over_blocks(const Slab& slab, const Work& work) {
  const std::size_t pixels = slab.values.size() / lanes;
  const int count = static_cast<int>((pixels + block - 1) / block);
  parallel_for(count, [&](int item) {
    const std::size_t first = product(item, block);
    work(first, std::min(first + block, pixels));
  });
}

}  // namespace

void side_by_side(std::span<const float* const> rows, int count, float* to, std::ptrdiff_t stride, int wide) {
  const int given = count_of(rows);
  int i = 0;
  for (; i + 4 <= count; i += 4) {
    float* at = to + i * stride;
    for (int s = 0; s < wide; s += 4) {
      Square square{};
      for (int n = 0; n < 4 && s + n < given; ++n) square.row[n] = load(rows[s + n] + i);
      square = turned(square);
      for (int n = 0; n < 4; ++n) store(at + n * stride + s, square.row[n]);
    }
  }
  for (; i < count; ++i) {
    for (int s = 0; s < wide; ++s) to[i * stride + s] = s < given ? rows[s][i] : 0.0F;
  }
}

void one_by_one(const float* from, std::ptrdiff_t stride, int count, std::span<float* const> rows) {
  const int wanted = count_of(rows);
  int i = 0;
  for (; i + 4 <= count; i += 4) {
    const float* at = from + i * stride;
    for (int s = 0; s < wanted; s += 4) {
      Square square;
      for (int n = 0; n < 4; ++n) square.row[n] = load(at + n * stride + s);
      square = turned(square);
      for (int n = 0; n < 4 && s + n < wanted; ++n) store(rows[s + n] + i, square.row[n]);
    }
  }
  for (; i < count; ++i) {
    for (int s = 0; s < wanted; ++s) rows[s][i] = from[i * stride + s];
  }
}

void pack(const float* images, int count, Slab& slab) {
  const std::size_t pixels = slab.values.size() / lanes;
  over_blocks(slab, [&](std::size_t first, std::size_t last) {
    std::array<const float*, lanes> from{};
    for (int s = 0; s < count; ++s) from[s] = images + product(s, pixels) + first;
    side_by_side(std::span(from).first(count), static_cast<int>(last - first), slab.values.data() + first * lanes,
                 lanes);
  });
}

void unpack(const Slab& slab, int count, float* images) {
  const std::size_t pixels = slab.values.size() / lanes;
  over_blocks(slab, [&](std::size_t first, std::size_t last) {
    std::array<float*, lanes> to{};
    for (int s = 0; s < count; ++s) to[s] = images + product(s, pixels) + first;
    one_by_one(slab.values.data() + first * lanes, lanes, static_cast<int>(last - first), std::span(to).first(count));
  });
}

}  // namespace vam
