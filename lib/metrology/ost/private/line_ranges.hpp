// SPDX-License-Identifier: GPL-3.0-or-later
// How well lines that are seen from both of their ends tell a motion: the errors of neighbouring lines are not
// independent, so that ranges of lines are compared [physics §8].
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "base/stats/measured.hpp"

namespace vam::metrology {

/// Gradients of ranges of lines, of one kind of range by another, on `unknowns` numbers.
template <std::size_t unknowns, std::size_t rows, std::size_t columns>
using RangePulls = std::array<std::array<std::array<double, unknowns>, columns>, rows>;

/// Sums of the squares of what ranges move each number by, alone: of rows, of columns, and of what both share.
template <std::size_t unknowns>
struct RangeMoves {
  std::array<double, unknowns> rows{}, columns{}, both{};
  std::array<double, unknowns> few{};  // factor on a deviation where few of `both` pull
};

/// `merged` ranges together, a divisor of both counts. move(gradient): of the numbers.
template <std::size_t unknowns, std::size_t rows, std::size_t columns, class Move>
[[nodiscard]] RangeMoves<unknowns> range_moves(const RangePulls<unknowns, rows, columns>& pulls, std::size_t merged,
                                               const Move& move) {
  using Vector = std::array<double, unknowns>;
  RangeMoves<unknowns> sums;
  std::array<std::vector<double>, unknowns> single;
  std::array<Vector, columns> of_column{};
  const auto add_square = [&](const Vector& pull, Vector& to) {
    const Vector moved = move(pull);
    for (std::size_t i = 0; i < unknowns; ++i) to[i] += moved[i] * moved[i];
    return moved;
  };
  for (std::size_t r = 0; r < rows; r += merged) {
    Vector of_row{};
    for (std::size_t c = 0; c < columns; c += merged) {
      Vector cell{};
      for (std::size_t n = 0; n < merged * merged; ++n) {
        for (std::size_t i = 0; i < unknowns; ++i) cell[i] += pulls[r + n / merged][c + n % merged][i];
      }
      for (std::size_t i = 0; i < unknowns; ++i) {
        of_row[i] += cell[i];
        of_column[c][i] += cell[i];
      }
      const Vector moved = add_square(cell, sums.both);
      for (std::size_t i = 0; i < unknowns; ++i) single[i].push_back(moved[i] * moved[i]);
    }
    add_square(of_row, sums.rows);
  }
  for (const Vector& column : of_column) add_square(column, sums.columns);
  for (std::size_t i = 0; i < unknowns; ++i) sums.few[i] = stats::few_parts_factor(single[i]);
  return sums;
}

/// A line: how well it sees the motion, squared, and the difference between its ends.
struct SeenLine {
  double sight;
  double difference;
};
/// The differences of lines on edges, those that see the motion better than the mean.
[[nodiscard]] std::vector<double> edge_differences(const std::vector<std::vector<SeenLine>>& heights);

}  // namespace vam::metrology
