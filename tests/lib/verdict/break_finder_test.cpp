// SPDX-License-Identifier: GPL-3.0-or-later
// Torn sets, against their definition on the whole volume.
#include "verdict/private/break_finder.hpp"

#include "lib/verdict/printed_volume.hpp"
#include "testing.hpp"

using namespace vam;
using namespace vam::test;

namespace {

/// Of each voxel the number of its piece, -1 for none: voxels of `is` that touch, by a corner at least.
std::vector<int> numbered(const Solid& is, int& pieces) {
  std::vector<int> piece(is.voxels.size(), -1);
  pieces = 0;
  for (int start = 0; start < static_cast<int>(piece.size()); ++start) {
    if (is.voxels[start] == 0 || piece[start] >= 0) continue;
    std::vector<int> open{start};
    piece[start] = pieces;
    while (!open.empty()) {
      const int i = open.back();
      open.pop_back();
      for (int n = 0; n < 27; ++n) {
        const int u = i % is.nx + n % 3 - 1;
        const int v = i / is.nx % is.ny + n / 3 % 3 - 1;
        const int w = i / is.nx / is.ny + n / 9 - 1;
        const int to = (w * is.ny + v) * is.nx + u;
        if (!is.at(u, v, w) || piece[to] >= 0) continue;
        piece[to] = pieces;
        open.push_back(to);
      }
    }
    ++pieces;
  }
  return piece;
}

/// Voxels that count by the definition, from the whole volume. beyond: whether what lies outside it is left.
std::int64_t torn_by_definition(const Solid& lost, const Solid& left, bool beyond, std::int64_t least_torn) {
  const auto near = [&](int i, const auto& visit) {
    for (int n = 0; n < 27; ++n) {
      visit(n, i % lost.nx + n % 3 - 1, i / lost.nx % lost.ny + n / 3 % 3 - 1, i / lost.nx / lost.ny + n / 9 - 1);
    }
  };
  const int all = static_cast<int>(lost.voxels.size());
  const auto is_in = [&](int u, int v, int w) {
    return u >= 0 && v >= 0 && w >= 0 && u < lost.nx && v < lost.ny && w < lost.nz;
  };
  Solid rim = left;
  for (int i = 0; i < all; ++i) {
    bool touches = false;
    near(i, [&](int, int u, int v, int w) { touches = touches || lost.at(u, v, w); });
    if (!touches) rim.voxels[i] = 0;
  }
  int sets = 0;
  int rims = 0;
  const std::vector<int> set = numbered(lost, sets);
  const std::vector<int> piece = numbered(rim, rims);
  std::vector<std::int64_t> voxels(sets, 0);
  Solid torn = lost;
  std::vector<char> falls_apart(all, 0);
  std::vector<std::vector<int>> beside(sets);
  for (int i = 0; i < all; ++i) {
    if (set[i] < 0) continue;
    ++voxels[set[i]];
    Solid around{3, 3, 3, std::vector<char>(27, 0)};
    near(i, [&](int n, int u, int v, int w) {
      around.voxels[n] = is_in(u, v, w) ? (left.at(u, v, w) ? 1 : 0) : (beyond ? 1 : 0);
      if (rim.at(u, v, w)) beside[set[i]].push_back(piece[(w * lost.ny + v) * lost.nx + u]);
    });
    int parts = 0;
    (void)numbered(around, parts);
    torn.voxels[i] = parts == 1 ? 0 : 1;
    falls_apart[i] = parts > 1 ? 1 : 0;
  }
  int tears = 0;
  const std::vector<int> tear = numbered(torn, tears);
  std::vector<std::int64_t> size(tears, 0);
  std::vector<std::int64_t> apart(tears, 0);
  std::vector<std::int64_t> torn_of(sets, 0);
  for (int i = 0; i < all; ++i) {
    if (tear[i] < 0) continue;
    ++torn_of[set[i]];
    ++size[tear[i]];
    apart[tear[i]] += falls_apart[i];
  }
  std::int64_t sum = 0;
  for (int i = 0; i < all; ++i) {
    if (set[i] < 0) continue;
    const auto& pieces = beside[set[i]];
    const auto [low, high] = std::minmax_element(pieces.begin(), pieces.end());
    const bool whole = pieces.empty() && torn_of[set[i]] == voxels[set[i]];
    const bool cut = !pieces.empty() && *low != *high;
    const bool is_torn = tear[i] >= 0 && (apart[tear[i]] >= 3 || size[tear[i]] >= least_torn);
    sum += whole || cut || is_torn ? 1 : 0;
  }
  return sum;
}

}  // namespace

TEST_CASE("torn sets are those of the whole volume, at every density and height of a pass") {
  constexpr int nx = 8;
  constexpr int ny = 6;
  constexpr int nz = 10;
  std::mt19937 draw(11);  // NOLINT(cert-msc51-cpp): the same prints every time
  int some = 0;
  for (const double covered : {0.2, 0.5, 0.9}) {
    for (const double cured : {0.05, 0.2, 0.5, 0.8, 0.95, 0.99}) {
      for (int trial = 0; trial < 40; ++trial) {
        std::bernoulli_distribution is_part(covered);
        std::bernoulli_distribution cures(cured);
        const std::vector<char> none(static_cast<std::size_t>(nx) * ny * nz, 0);
        Solid lost{nx, ny, nz, none}, left = lost, filled = lost, open = lost;  // of the part, of gaps
        Print print(nx, ny);
        int at = 0;
        for (int k = 0; k < nz; ++k) {
          std::array<bool, nx * ny> part{};
          std::array<bool, nx * ny> cure{};
          for (int i = 0; i < nx * ny; ++i, ++at) {
            part[i] = is_part(draw);
            cure[i] = cures(draw);
            (part[i] ? (cure[i] ? left : lost) : (cure[i] ? filled : open)).voxels[at] = 1;
          }
          print.add([&](int i) { return part[i] ? 1.0F : 0.0F; }, [&](int i) { return cure[i]; });
        }
        const auto found = print.found(1 + trial % 4);
        const auto is_in = [](const verdict::Defects& torn, const Solid& solid) {
          return torn.voxels == 0 || (solid.at(torn.at.column, torn.at.row, torn.at.slice) && torn.largest > 0 &&
                                      torn.largest <= torn.voxels);
        };
        CHECK(found.broken.voxels == torn_by_definition(lost, left, false, 27));
        CHECK(found.shut.voxels == torn_by_definition(filled, open, true, 3));
        CHECK(is_in(found.broken, lost));
        CHECK(is_in(found.shut, filled));
        some += found.broken.voxels > 0 && found.shut.voxels > 0 ? 1 : 0;
      }
    }
  }
  CHECK(some > 100);
}
