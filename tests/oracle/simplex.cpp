// SPDX-License-Identifier: GPL-3.0-or-later
#include "oracle/simplex.hpp"

#include <cmath>
#include <cstddef>
#include <stdexcept>

namespace vam::oracle {

namespace {

using Real = long double;
constexpr Real tiny = 1e-12L;

// rows x (columns + 1); the last column is the right-hand side; the last row the reduced cost.
struct Tableau {
  std::vector<std::vector<Real>> cell;
  std::vector<std::size_t> basis;

  void pivot(std::size_t row, std::size_t column) {
    const Real by = cell[row][column];
    for (Real& value : cell[row]) value /= by;
    for (std::size_t r = 0; r < cell.size(); ++r) {
      if (r == row) continue;
      const Real factor = cell[r][column];
      if (factor == 0) continue;
      for (std::size_t c = 0; c < cell[r].size(); ++c) cell[r][c] -= factor * cell[row][c];
    }
    basis[row] = column;
  }

  // Bland: the first column with a negative reduced cost, the row of the smallest ratio with the smallest basis index.
  void solve(std::size_t columns) {
    const std::size_t rows = basis.size();
    for (;;) {
      std::size_t enter = columns;
      for (std::size_t c = 0; c < columns && enter == columns; ++c) {
        if (cell[rows][c] < -tiny) enter = c;
      }
      if (enter == columns) return;
      std::size_t leave = rows;
      Real best = 0;
      for (std::size_t r = 0; r < rows; ++r) {
        if (cell[r][enter] <= tiny) continue;
        const Real ratio = cell[r].back() / cell[r][enter];
        const bool better = leave == rows || ratio < best - tiny || (ratio <= best + tiny && basis[r] < basis[leave]);
        if (better) {
          leave = r;
          best = ratio;
        }
      }
      if (leave == rows) throw std::runtime_error("unbounded linear program");
      pivot(leave, enter);
    }
  }
};

}  // namespace

std::optional<Optimum> minimise(const LinearProgram& program) {
  const std::size_t n = program.cost.size();
  const std::size_t m = program.b.size();
  const std::size_t columns = n + 2 * m;  // x, slacks, artificials
  Tableau t;
  t.cell.assign(m + 1, std::vector<Real>(columns + 1, 0));
  t.basis.resize(m);
  for (std::size_t r = 0; r < m; ++r) {
    const Real sign = program.b[r] < 0 ? -1 : 1;
    for (std::size_t c = 0; c < n; ++c) t.cell[r][c] = sign * static_cast<Real>(program.a[r][c]);
    t.cell[r][n + r] = sign;
    t.cell[r][n + m + r] = 1;
    t.cell[r][columns] = sign * static_cast<Real>(program.b[r]);
    t.basis[r] = n + m + r;
    for (std::size_t c = 0; c <= columns; ++c) {
      if (c < n + m || c == columns) t.cell[m][c] -= t.cell[r][c];  // phase 1: the sum of the artificials
    }
  }
  t.solve(n + m);
  if (t.cell[m][columns] < -1e-9L) return std::nullopt;
  for (std::size_t r = 0; r < m; ++r) {  // artificials that stay in the basis at zero leave it
    if (t.basis[r] < n + m) continue;
    for (std::size_t c = 0; c < n + m; ++c) {
      if (std::fabs(t.cell[r][c]) > 1e-9L) {
        t.pivot(r, c);
        break;
      }
    }
  }
  for (Real& value : t.cell[m]) value = 0;  // phase 2: the cost, expressed without the basis
  for (std::size_t c = 0; c < n; ++c) t.cell[m][c] = static_cast<Real>(program.cost[c]);
  for (std::size_t r = 0; r < m; ++r) {
    if (t.basis[r] >= n) continue;
    const Real factor = static_cast<Real>(program.cost[t.basis[r]]);
    for (std::size_t c = 0; c <= columns; ++c) t.cell[m][c] -= factor * t.cell[r][c];
  }
  t.solve(n + m);
  Optimum best{std::vector<double>(n, 0.0), 0};
  for (std::size_t r = 0; r < m; ++r) {
    if (t.basis[r] < n) best.x[t.basis[r]] = static_cast<double>(t.cell[r][columns]);
  }
  for (std::size_t c = 0; c < n; ++c) best.value += program.cost[c] * best.x[c];
  return best;
}

}  // namespace vam::oracle
