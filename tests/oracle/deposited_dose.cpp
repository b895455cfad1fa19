// SPDX-License-Identifier: GPL-3.0-or-later
#include "oracle/deposited_dose.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <tuple>
#include <utility>

namespace vam::oracle {

namespace {

/// A ray in the resin: its way is p + s d, s from 0 to `length`.
struct Way {
  std::array<double, 3> p{}, d{};
  double transmittance = 0;
  double length = 0;
};

std::optional<Way> way_of(const Bench& bench, double x, double z) {
  const auto ray = trace(bench, x, z);
  if (!ray) return std::nullopt;
  Way way;
  for (std::size_t a = 0; a < 3; ++a) {
    way.p[a] = static_cast<double>(ray->point[a]);
    way.d[a] = static_cast<double>(ray->direction[a]);
  }
  way.transmittance = static_cast<double>(ray->transmittance);
  const auto& [p, d] = std::tie(way.p, way.d);
  way.length = -2 * (p[0] * d[0] + p[1] * d[1]) / (d[0] * d[0] + d[1] * d[1]);
  return way;
}

/// Calls visit(i, j, k, s, length) for every voxel on the way of a ray in the part's frame.
template <class Visit>
void walk(const Deposit& setup, const Way& way, const Visit& visit) {
  const std::array<int, 3> count{setup.size, setup.size, setup.slices};
  const std::array<double, 3> edge{setup.voxel, setup.voxel, setup.height};
  const std::array<double, 3> low{-0.5 * setup.size * setup.voxel, -0.5 * setup.size * setup.voxel,
                                  setup.first_slice - 0.5 * setup.height};
  double from = 0;
  double to = way.length;
  for (std::size_t a = 0; a < 3; ++a) {
    const double high = low[a] + count[a] * edge[a];
    if (way.d[a] == 0) {
      if (way.p[a] < low[a] || way.p[a] >= high) return;
      continue;
    }
    const double one = (low[a] - way.p[a]) / way.d[a];
    const double other = (high - way.p[a]) / way.d[a];
    from = std::max(from, std::min(one, other));
    to = std::min(to, std::max(one, other));
  }
  if (from >= to) return;
  std::array<int, 3> at{}, step{};
  std::array<double, 3> next{}, pace{};
  for (std::size_t a = 0; a < 3; ++a) {
    const double in = (way.p[a] + (from + 1e-12) * way.d[a] - low[a]) / edge[a];
    at[a] = std::clamp(static_cast<int>(std::floor(in)), 0, count[a] - 1);
    step[a] = way.d[a] > 0 ? 1 : -1;
    if (way.d[a] == 0) {
      next[a] = pace[a] = std::numeric_limits<double>::infinity();
      continue;
    }
    pace[a] = edge[a] / std::abs(way.d[a]);
    next[a] = (low[a] + (at[a] + (step[a] > 0 ? 1 : 0)) * edge[a] - way.p[a]) / way.d[a];
  }
  for (double s = from; s < to;) {
    const std::size_t a = next[0] < next[1] ? (next[0] < next[2] ? 0 : 2) : (next[1] < next[2] ? 1 : 2);
    const double end = std::min(next[a], to);
    if (end > s) visit(at[0], at[1], at[2], s, end - s);
    s = std::max(s, end);
    at[a] += step[a];
    next[a] += pace[a];
    if (at[a] < 0 || at[a] >= count[a]) return;
  }
}

/// A ray at one angle and at the three a quarter of a turn on, in which it takes the same way turned over.
void deposit_quarters(const Deposit& setup, const Way& way, const std::array<double, 4>& light,
                      std::vector<double>& dose) {
  const int n = setup.size;
  walk(setup, way, [&](int i, int j, int k, double s, double length) {
    const double left = setup.absorption > 0 ? std::exp(-setup.absorption * (s + 0.5 * length)) : 1.0;
    double* slice = dose.data() + static_cast<std::size_t>(k) * n * static_cast<std::size_t>(n);
    const std::array<std::array<int, 2>, 4> places{{{i, j}, {n - 1 - j, i}, {n - 1 - i, n - 1 - j}, {j, n - 1 - i}}};
    for (std::size_t q = 0; q < 4; ++q) {
      slice[static_cast<std::size_t>(places[q][1]) * n + static_cast<std::size_t>(places[q][0])] +=
          light[q] * left * length;
    }
  });
}

}  // namespace

void deposit(const Deposit& setup, const Image& row, double z, Deposited& result) {
  const double ray_area = setup.pixel * setup.row / (setup.rays * setup.rays);
  const double volume = setup.voxel * setup.voxel * setup.height;
  const int quarter = setup.angles / 4;
  for (int c = 0; c < row.width; ++c) {
    bool dark = true;
    for (int a = 0; a < setup.angles && dark; ++a) dark = row(c, a) == 0;
    for (int n = 0; n < setup.rays * setup.rays && !dark; ++n) {
      const double x = (c - setup.axis_column + (n % setup.rays + 0.5) / setup.rays - 0.5) * setup.pixel;
      // Heights differ from column to column of rays (golden section), or all would jump into the next slice at once.
      const double phase = std::fmod(0.6180339887 * (c * setup.rays + n % setup.rays), 1.0);
      const double up = ((n / setup.rays + phase) / setup.rays - 0.5) * setup.row;
      const auto still = way_of(setup.bench, x, z + up);
      if (!still) continue;
      for (int a = 0; a < quarter; ++a) {
        std::array<double, 4> light{};
        double sum = 0;
        for (int q = 0; q < 4; ++q) {
          light[q] = static_cast<double>(row(c, a + q * quarter)) * still->transmittance * ray_area;
          sum += light[q];
        }
        if (sum == 0) continue;
        result.entered += sum;
        result.absorbed += sum * (1 - std::exp(-setup.absorption * still->length));
        for (double& one : light) one *= std::abs(setup.angle_step) / volume;
        const double theta = setup.first_angle + a * setup.angle_step;
        Way turned = *still;
        turned.p = {still->p[0] * std::cos(theta) - still->p[1] * std::sin(theta),
                    still->p[0] * std::sin(theta) + still->p[1] * std::cos(theta), still->p[2]};
        turned.d = {still->d[0] * std::cos(theta) - still->d[1] * std::sin(theta),
                    still->d[0] * std::sin(theta) + still->d[1] * std::cos(theta), still->d[2]};
        if (setup.angle_step < 0) std::swap(light[1], light[3]);
        deposit_quarters(setup, turned, light, result.dose);
      }
    }
  }
}

}  // namespace vam::oracle
