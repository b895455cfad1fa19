// SPDX-License-Identifier: GPL-3.0-or-later
#include "plot/contour.hpp"

#include <array>

namespace vam::plot {

namespace {

// The corners of a square of four pixel middles, and its sides from corner to corner: up, right, down, left.
constexpr std::array<std::array<int, 2>, 4> corners{{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};

struct Square {
  std::array<float, 4> value;
  double x;
  double y;
  float level;

  [[nodiscard]] bool inside(std::size_t corner) const { return value[corner] >= level; }

  // Where side s, from corner s to the next, crosses the level.
  [[nodiscard]] Spot crossing(std::size_t s) const {
    const std::size_t next = (s + 1) % 4;
    const double part = static_cast<double>((level - value[s]) / (value[next] - value[s]));
    return {x + corners[s][0] + part * (corners[next][0] - corners[s][0]),
            y + corners[s][1] + part * (corners[next][1] - corners[s][1])};
  }
};

void add_pieces(const Square& square, std::vector<ContourPiece>& pieces) {
  std::array<std::size_t, 4> crossed{};
  std::size_t count = 0;
  for (std::size_t s = 0; s < 4; ++s) {
    if (square.inside(s) != square.inside((s + 1) % 4)) crossed[count++] = s;
  }
  if (count == 2) pieces.push_back({square.crossing(crossed[0]), square.crossing(crossed[1])});
  if (count < 4) return;
  const auto& v = square.value;
  const bool middle_inside = 0.25F * (v[0] + v[1] + v[2] + v[3]) >= square.level;
  // Cut off the two corners that differ from the middle: each lies between side corner - 1 and side corner.
  for (std::size_t corner = 0; corner < 4; ++corner) {
    if (square.inside(corner) != middle_inside)
      pieces.push_back({square.crossing((corner + 3) % 4), square.crossing(corner)});
  }
}

}  // namespace

std::vector<ContourPiece> contour(const Image& image, float level) {
  std::vector<ContourPiece> pieces;
  for (int y = 0; y + 1 < image.height; ++y) {
    for (int x = 0; x + 1 < image.width; ++x) {
      const Square square{
          {image(x, y), image(x + 1, y), image(x + 1, y + 1), image(x, y + 1)}, double(x), double(y), level};
      add_pieces(square, pieces);
    }
  }
  return pieces;
}

}  // namespace vam::plot
