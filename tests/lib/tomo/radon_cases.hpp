// SPDX-License-Identifier: GPL-3.0-or-later
// What the tests of both projectors share: geometries, and a disc whose projections are known.
#pragma once

#include "testing.hpp"
#include "tomo/radon.hpp"

namespace radon_cases {

using namespace vam;

inline constexpr double pi = std::numbers::pi;

inline tomo::ParallelGeometry full_turn(int n, int columns, int angles) {
  return {n, n, columns, angles, 0.5 * (n - 1), 0.5 * (n - 1), 0, 2 * pi / angles, 0};
}

struct Case {
  const char* name;
  tomo::ParallelGeometry geometry;
};

/// Odd sizes, an axis off centre, too few columns, angles on the axes and diagonals; and others.
inline std::vector<Case> cases_and(const std::vector<Case>& others) {
  std::vector<Case> cases{
      {"full turn, even", full_turn(40, 60, 24)},
      {"full turn, odd columns", full_turn(33, 51, 20)},
      {"full turn, odd number of angles", full_turn(33, 51, 19)},
      {"half turn, negative step", {70, 45, 90, 23, 34.5, 22, 0.3, -pi / 23, 0}},
      {"axis off centre, off the pixel grid", {37, 29, 71, 17, 5.3, 20.9, 0.1, 2 * pi / 17, 0}},
      {"columns fewer than needed", {64, 40, 31, 18, 31.5, 19.5, 0, 2 * pi / 18, 0}},
      {"one pixel", {1, 1, 3, 8, 0, 0, 0, 2 * pi / 8, 0}},
      {"one angle", {20, 20, 31, 1, 9.5, 9.5, pi / 4, 1, 0}},
  };
  cases.insert(cases.end(), others.begin(), others.end());
  return cases;
}

inline double dot(const Slab& a, const Slab& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.values.size(); ++i)
    sum += static_cast<double>(a.values[i]) * static_cast<double>(b.values[i]);
  return sum;
}

/// Off the centre, anti-aliased by 16 x 16 sub-pixels; its projections are chords, averaged over the bin, which is what
/// a bin measures.
struct Disc {
  static constexpr int n = 512, columns = 725, angles = 90;
  static constexpr double radius = 150.3, cx = 40.2, cy = -55.7;
  tomo::ParallelGeometry g = full_turn(n, columns, angles);
  std::vector<Slab> image{Slab(n, n)};

  Disc() {
    g.angle_start_rad = 0.01;
    for (const auto [j, i] : indices(n, n)) {
      int inside = 0;
      for (int s = 0; s < 256; ++s) {
        const double x = i - g.axis_x - cx + (s % 16 - 7.5) / 16;
        const double y = j - g.axis_y - cy + (s / 16 - 7.5) / 16;  // NOLINT(bugprone-integer-division)
        inside += x * x + y * y <= radius * radius ? 1 : 0;
      }
      *image[0].at(i, j) = static_cast<float>(inside) / 256;
    }
  }

  static double area_left_of(double t) {
    const double x = std::clamp(t / radius, -1.0, 1.0);
    return radius * radius * (x * std::sqrt(1 - x * x) + std::asin(x) + pi / 2);
  }

  void judge(const Slab& sinogram) const {
    double error = 0, norm = 0;
    for (const auto [a, c] : indices(angles, columns)) {
      const double theta = g.angle_start_rad + a * g.angle_step_rad;
      const double t = c - 0.5 * (columns - 1) - (cx * std::cos(theta) + cy * std::sin(theta));
      const double chord = area_left_of(t + 0.5) - area_left_of(t - 0.5);
      const double off = static_cast<double>(*sinogram.at(c, a)) - chord;
      error += off * off;
      norm += chord * chord;
      // Nearer the rim the pixels of the rim itself beat with the bins, by up to 0.35 px for exact strip areas.
      if (std::abs(t) < 0.8 * radius) CHECK(std::abs(off) / chord < 2e-3);
    }
    CHECK(std::sqrt(error / norm) < 1e-3);
  }
};

}  // namespace radon_cases
