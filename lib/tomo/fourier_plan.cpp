// SPDX-License-Identifier: GPL-3.0-or-later
#include "tomo/private/fourier_plan.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/compute/parallel.hpp"
#include "base/error.hpp"
#include "base/index.hpp"
#include "tomo/private/gridding.hpp"

namespace vam::tomo {

namespace {

using std::numbers::pi;

double sinc(double x) { return std::abs(x) < 1e-9 ? 1.0 : std::sin(pi * x) / (pi * x); }

/// Columns from the first to one past the last that the image's shadow or the detector covers at some angle.
int covered_columns(const ParallelGeometry& geometry, const Plan& turn) {
  double low = 0;
  double high = geometry.columns;
  for (const Ray& ray : turn.rays) {
    for (const int x : {0, geometry.nx - 1}) {
      for (const int y : {0, geometry.ny - 1}) {
        const double t = x * ray.cosine + y * ray.sine + ray.offset;
        low = std::min(low, t - 2);  // half a footprint, at most 1.3 px, and the rounding
        high = std::max(high, t + 3);
      }
    }
  }
  return ceil_int(high) - floor_int(low);
}

/// The whole multiple of `period` that brings `position` to [0, period), less what rounding does.
double shift_into(double position, int period) { return -std::floor(position / period) * period; }

/// Cuts the lines where they pass from one tile to the next.
void make_runs(FourierPlan& plan) {
  plan.tiles_x = plan.kept_x() / plan.tile_cells() + 1;
  plan.tiles_y = plan.grid_y / plan.tile_cells() + 1;
  plan.tiles.resize(product(plan.tiles_x, plan.tiles_y));
  for (int angle = 0; angle < plan.rays(); ++angle) {
    std::size_t last = plan.tiles.size();
    for (int j = std::max(plan.first_j(), 1 - plan.length); j < plan.length; ++j) {
      const double along_x = j * plan.step_x(angle);
      const bool opposite = plan.real && along_x + shift_into(along_x, plan.grid_x) > 0.5 * plan.grid_x;
      const int sign = opposite ? -1 : 1;
      const double x = sign * along_x;
      const double y = sign * j * plan.step_y(angle);
      const double shift_x = shift_into(x, plan.grid_x);
      const double shift_y = shift_into(y, plan.grid_y);
      const int tile_x = static_cast<int>(x + shift_x) / plan.tile_cells();
      const int tile_y = static_cast<int>(y + shift_y) / plan.tile_cells();
      const std::size_t tile = flat_index(tile_y, plan.tiles_x, tile_x);
      auto& runs = plan.tiles[tile];
      if (tile == last && runs.back().sign == sign && runs.back().shift_x == shift_x &&
          runs.back().shift_y == shift_y) {
        ++runs.back().count;
      } else {
        runs.push_back({angle, j, 1, sign, shift_x, shift_y});
      }
      last = tile;
    }
  }
}

/// The transforms of pixel and bin, boxes, at k cycles per pixel, for an image whose centre is at `column`. Along an
/// axis all aliases of k, k + 1, ... are the same value of the image's transform: the two bins between which all pixels
/// of a column are shared stand for all of them, and none are left above half a cycle.
std::complex<double> boxes(double k, const Ray& ray, double column) {
  constexpr double aligned = 1e-9;
  const std::complex<double> centre = std::polar(1.0, -2 * pi * k * column);
  if (std::min(std::abs(ray.cosine), std::abs(ray.sine)) > aligned) {
    return sinc(k) * sinc(k * ray.cosine) * sinc(k * ray.sine) * centre;
  }
  const double share = column - std::floor(column);
  const double part = std::abs(k) < 0.5 ? 1.0 : std::abs(k) > 0.5 ? 0.0 : 0.5;
  return part * ((1 - share) * std::polar(1.0, -2 * pi * k * (column - share)) +
                 share * std::polar(1.0, -2 * pi * k * (column - share + 1)));
}

void make_factors(FourierPlan& plan) {
  plan.factors.assign(product(plan.rays(), plan.points()), {});
  parallel_for(plan.rays(), [&](int angle) {
    const Ray& ray = plan.turn.rays[angle];
    const double column = plan.centre_x * ray.cosine + plan.centre_y * ray.sine + ray.offset;
    std::complex<float>* to = &plan.factors[product(angle, plan.points())];
    for (int j = std::max(plan.first_j(), 1 - plan.length); j < plan.length; ++j) {
      const double k = static_cast<double>(j) / plan.length;
      to[j - plan.first_j()] = std::complex<float>(boxes(k, ray, column) / static_cast<double>(plan.length));
    }
  });
}

}  // namespace

FourierPlan make_fourier_plan(const ParallelGeometry& geometry, bool one_slice) {
  if (geometry.alpha_per_px != 0) throw Error{Fault::bug, "Fourier projection of an absorber"};
  FourierPlan plan{};
  plan.turn = make_plan(geometry, {}, {});
  plan.columns = geometry.columns;
  plan.real = one_slice;
  plan.width = geometry.nx;
  plan.height = geometry.ny;
  plan.centre_x = plan.width / 2;
  plan.centre_y = plan.height / 2;
  plan.grid_x = grid_points(plan.width);
  plan.grid_y = grid_points(plan.height);
  plan.length = smooth_length(covered_columns(geometry, plan.turn));
  plan.weight_x = deapodisation(plan.width, plan.centre_x, plan.grid_x);
  plan.weight_y = deapodisation(plan.height, plan.centre_y, plan.grid_y);
  make_runs(plan);
  make_factors(plan);
  return plan;
}

}  // namespace vam::tomo
