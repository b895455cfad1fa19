// SPDX-License-Identifier: GPL-3.0-or-later
// Pieces of solids of voxels, against a flood fill.
#include "model/print_pieces.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <random>
#include <vector>

using namespace vam;

namespace {

struct Solid {
  int nx, ny, nz;
  std::vector<char> voxels;
  [[nodiscard]] bool at(int x, int y, int z) const {
    return x >= 0 && y >= 0 && z >= 0 && x < nx && y < ny && z < nz && voxels[(z * ny + y) * nx + x] != 0;
  }
};

int counted(const Solid& solid, std::int64_t least) {
  model::PieceCounter counter;
  for (int z = 0; z < solid.nz; ++z) {
    counter.add(model::runs_of(solid.nx, solid.ny, [&](std::size_t i) {
      return solid.voxels[z * solid.nx * solid.ny + static_cast<int>(i)] != 0;
    }));
  }
  return counter.count(least);
}

int flooded(Solid solid, std::int64_t least) {
  int pieces = 0;
  for (int start = 0; start < static_cast<int>(solid.voxels.size()); ++start) {
    if (solid.voxels[start] == 0) continue;
    std::int64_t size = 0;
    std::vector<int> open{start};
    solid.voxels[start] = 0;
    while (!open.empty()) {
      const int i = open.back();
      open.pop_back();
      ++size;
      const int x = i % solid.nx;
      const int y = i / solid.nx % solid.ny;
      const int z = i / solid.nx / solid.ny;
      for (int n = 0; n < 27; ++n) {
        const int u = x + n % 3 - 1;
        const int v = y + n / 3 % 3 - 1;
        const int w = z + n / 9 - 1;
        if (!solid.at(u, v, w)) continue;
        solid.voxels[(w * solid.ny + v) * solid.nx + u] = 0;
        open.push_back((w * solid.ny + v) * solid.nx + u);
      }
    }
    if (size >= least) ++pieces;
  }
  return pieces;
}

}  // namespace

TEST_CASE("pieces are those of a flood fill, at every density") {
  std::mt19937 draw(7);  // NOLINT(cert-msc51-cpp): the same solids every time
  for (const double density : {0.02, 0.06, 0.1, 0.2, 0.4, 0.9}) {
    for (int trial = 0; trial < 20; ++trial) {
      Solid solid{9, 7, 8, std::vector<char>(9 * 7 * 8)};
      std::bernoulli_distribution covered(density);
      std::generate(solid.voxels.begin(), solid.voxels.end(), [&] { return covered(draw) ? 1 : 0; });
      for (const int least : {1, 2, 8}) CHECK(counted(solid, least) == flooded(solid, least));
    }
  }
}

TEST_CASE("a wall without its foot is a piece of its own; one that hangs on by its end is cut") {
  constexpr int width = 9;
  constexpr int height = 12;
  const auto pieces = [&](int foot) {  // so many voxels of the wall's foot cure
    model::PrintPieceCounter counter(width, height);
    for (int k = 0; k < 8; ++k) {
      std::vector<std::uint8_t> slice(width * height, 0);
      for (int i = 0; i < width * height; ++i) {
        const bool part = k < 3 || i % width == 4;
        slice[i] = model::printed_bits(part ? 1 : 0, part && (k != 3 || i / width < foot));
      }
      counter.add({slice});
    }
    return counter.found();
  };
  CHECK(pieces(height).print == 1);
  CHECK(pieces(height).broken == 0);
  CHECK(pieces(height).is_as_part());
  CHECK(pieces(2).part == 1);
  CHECK(pieces(2).print == 1);
  CHECK(pieces(2).broken == height - 3);  // the one beside those that cure is joined by them
  CHECK(!pieces(2).is_as_part());
  CHECK(pieces(0).print == 2);
  CHECK(pieces(0).broken == height);
}

TEST_CASE("rough faces and holes in walls cut nothing, however the slices come") {
  constexpr int size = 10;
  std::vector<std::vector<std::uint8_t>> slices;
  for (int k = 0; k < size; ++k) {
    std::vector<std::uint8_t> slice(size * size, 0);
    for (int i = 0; i < size * size; ++i) {
      const bool part = k < 5 || i % size == 5;
      const bool rough = k == 4 && i % 3 != 0 && i % size != 5;
      const bool hole = k > 5 && k < 8 && i / size % 4 == 2;
      slice[i] = model::printed_bits(part ? 1 : 0, part && !rough && !hole);
    }
    slices.push_back(slice);
  }
  model::PrintPieceCounter together(size, size);
  together.add(slices);
  model::PrintPieceCounter apart(size, size);
  for (const auto& slice : slices) apart.add({slice});
  CHECK(together.found().broken == 0);
  CHECK(apart.found().broken == 0);
  CHECK(together.found().print == 1);
}

TEST_CASE(
    "a wall that does not cure, or has a wide hole, is broken; a rod of a voxel's width holds the part together") {
  constexpr int size = 12;
  const auto found = [&](int low, int high) {  // of a wall at x = 5, no voxel of it cures within this range
    model::PrintPieceCounter counter(size, size);
    for (int k = 0; k < size; ++k) {
      std::vector<std::uint8_t> slice(size * size, 0);
      for (int i = 0; i < size * size; ++i) {
        const auto within = [&](int at) { return at >= low && at < high; };
        const bool wall = i % size == 5;
        slice[i] = model::printed_bits(wall ? 0.8F : 0.1F, wall && !(within(k) && within(i / size)));
      }
      counter.add({slice});
    }
    return counter.found();
  };
  CHECK(found(0, 0).broken == 0);
  CHECK(found(4, 6).broken == 0);
  CHECK(found(3, 8).broken == 9);  // all but the rim of 5 x 5
  CHECK(!found(3, 8).is_as_part());
  CHECK(found(0, size).broken == size * size);
  model::PrintPieceCounter thin(size, size);
  for (int k = 0; k < size; ++k) {
    std::vector<std::uint8_t> slice(size * size, model::printed_bits(k < 4 || k > 7 ? 1 : 0, k < 4 || k > 7));
    if (k >= 4 && k <= 7) slice[size * 6 + 6] = model::printed_bits(0.4F, false);
    thin.add({slice});
  }
  CHECK(thin.found().part == 1);
  CHECK(thin.found().print == 2);
}
