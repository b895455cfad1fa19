// SPDX-License-Identifier: GPL-3.0-or-later
#include "solid/voxel/wall.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <mutex>
#include <tuple>
#include <utility>
#include <vector>

#include "base/compute/parallel.hpp"
#include "model/dose/dose_metrics.hpp"
#include "solid/voxel/private/neck.hpp"

namespace vam::solid {

namespace {

constexpr std::int64_t far_away = std::numeric_limits<std::int32_t>::max();
constexpr double thin_share = 0.01;
constexpr double sharp_share = 0.01;     // of the middle, that makes edges sharp
constexpr double widest_cosine = -0.94;  // of the directions into both faces of a wall: 20 degrees apart from parallel
constexpr double farthest_of_ball = 1.25;  // the way through a wall's middle, but for two voxels
constexpr double accuracy = 1.5;           // of a thickness, voxels
constexpr int window = 3;                  // voxels around a place that tell which way a face looks

/// The grid with a layer of void around it, x fastest.
struct Field {
  std::array<int, 3> size{};
  std::vector<std::uint8_t> solid;
  std::vector<std::int32_t> nearest;  // index of the void voxel that is nearest

  [[nodiscard]] std::int64_t index(int i, int j, int k) const {
    return (static_cast<std::int64_t>(k) * size[1] + j) * size[0] + i;
  }
  [[nodiscard]] std::array<int, 3> place(std::int64_t at) const {  // divides 32 bits: much quicker than 64
    const auto here = static_cast<std::uint32_t>(at);
    const auto nx = static_cast<std::uint32_t>(size[0]);
    const auto ny = static_cast<std::uint32_t>(size[1]);
    const std::uint32_t row = here / nx;
    return {static_cast<int>(here - row * nx), static_cast<int>(row % ny), static_cast<int>(row / ny)};
  }
  [[nodiscard]] std::int64_t squared(std::int64_t a, std::int64_t b) const {
    const auto p = place(a);
    const auto q = place(b);
    std::int64_t sum = 0;
    for (std::size_t axis = 0; axis < 3; ++axis)
      sum += static_cast<std::int64_t>(p[axis] - q[axis]) * (p[axis] - q[axis]);
    return sum;
  }
};

Field padded(const model::Volume& part) {
  const model::Grid& grid = part.grid;
  Field field{{grid.nx + 2, grid.ny + 2, grid.nz + 2}, {}, {}};
  const auto all = static_cast<std::size_t>(field.index(0, 0, field.size[2]));
  field.solid.assign(all, 0);
  field.nearest.assign(all, -1);
  for (int k = 0; k < grid.nz; ++k) {
    for (int j = 0; j < grid.ny; ++j) {
      const float* row = part.slice(k) + static_cast<std::ptrdiff_t>(j) * grid.nx;
      for (int i = 0; i < grid.nx; ++i)
        field.solid[field.index(i + 1, j + 1, k + 1)] = model::half_covered(row[i]) ? 1 : 0;
    }
  }
  for (std::size_t at = 0; at < all; ++at)
    if (field.solid[at] == 0) field.nearest[at] = static_cast<std::int32_t>(at);
  return field;
}

/// One line along an axis: of all nearest voids of the line, by the lower envelope of their parabolas.
void sweep(Field& field, std::int64_t first, std::int64_t stride, int count) {
  std::vector<int> hull;      // places whose parabolas make the envelope
  std::vector<double> begin;  // where each begins
  std::vector<std::int32_t> found(static_cast<std::size_t>(count));
  std::vector<double> heights(found.size());
  const auto at = [&](int n) { return static_cast<std::size_t>(first + n * stride); };
  const auto height = [&](int n) { return heights[n]; };
  for (int n = 0; n < count; ++n) {
    const std::int32_t own = found[n] = field.nearest[at(n)];
    if (own < 0) continue;
    heights[n] = static_cast<double>(field.squared(static_cast<std::int64_t>(at(n)), own));
    double from = -static_cast<double>(far_away);
    while (!hull.empty()) {
      const int m = hull.back();
      from = (height(n) + double(n) * n - height(m) - double(m) * m) / (2.0 * (n - m));
      if (from > begin.back()) break;
      hull.pop_back();
      begin.pop_back();
      from = -static_cast<double>(far_away);
    }
    hull.push_back(n);
    begin.push_back(from);
  }
  std::size_t piece = 0;
  for (int n = 0; n < count && !hull.empty(); ++n) {
    while (piece + 1 < hull.size() && begin[piece + 1] < n) ++piece;
    field.nearest[at(n)] = found[hull[piece]];
  }
}

void find_nearest(Field& field) {
  const auto [nx, ny, nz] = field.size;
  parallel_for(nz, [&, nx = nx, ny = ny](int k) {
    for (int j = 0; j < ny; ++j) sweep(field, field.index(0, j, k), 1, nx);
    for (int i = 0; i < nx; ++i) sweep(field, field.index(i, 0, k), nx, ny);
  });
  parallel_for(ny, [&, nx = nx, ny = ny, nz = nz](int j) {
    for (int i = 0; i < nx; ++i) sweep(field, field.index(i, j, 0), static_cast<std::int64_t>(nx) * ny, nz);
  });
}

/// No voxel around is farther from the void.
bool is_middle(const Field& field, int i, int j, int k) {
  const std::int64_t here = field.index(i, j, k);
  const std::int64_t own = field.squared(here, field.nearest[here]);
  for (int n = 0; n < 27; ++n) {
    const std::int64_t there = field.index(i + n % 3 - 1, j + n / 3 % 3 - 1, k + n / 9 - 1);
    if (field.squared(there, field.nearest[there]) > own) return false;
  }
  return true;
}

/// The way through a voxel, from the nearest void straight on to the void on the other side.
struct Crossing {
  double thickness;
  double ball;                   // diameter of the one around the voxel that the faces hold
  std::array<int, 3> near, far;  // the void voxels
};

Crossing crossing(const Field& field, std::int64_t here) {
  const auto p = field.place(here);
  const auto v = field.place(field.nearest[here]);
  const double distance = std::sqrt(static_cast<double>(field.squared(here, field.nearest[here])));
  constexpr double step = 0.25;
  for (double way = step;; way += step) {
    std::array<int, 3> at{};
    for (std::size_t axis = 0; axis < 3; ++axis)
      at[axis] = static_cast<int>(std::lround(p[axis] + way * (p[axis] - v[axis]) / distance));
    if (field.solid[field.index(at[0], at[1], at[2])] == 0) {
      return {distance - 0.5 + way - 0.5 * step, 2 * distance - 1, v, at};  // faces are half a voxel from the middles
    }
  }
}

/// Towards the part, from a place at its face: to the middle of what lies around; not of length 1.
std::array<double, 3> inwards(const model::Volume& part, const std::array<int, 3>& at) {
  const model::Grid& grid = part.grid;
  std::array<double, 3> sum{};
  for (int n = 0; n < (2 * window + 1) * (2 * window + 1) * (2 * window + 1); ++n) {
    constexpr int edge = 2 * window + 1;
    const std::array<int, 3> by{n % edge - window, n / edge % edge - window, n / edge / edge - window};
    if (by[0] * by[0] + by[1] * by[1] + by[2] * by[2] > window * window) continue;  // a ball favours no direction
    const int i = at[0] - 1 + by[0];
    const int j = at[1] - 1 + by[1];
    const int k = at[2] - 1 + by[2];
    if (i < 0 || j < 0 || k < 0 || i >= grid.nx || j >= grid.ny || k >= grid.nz) continue;
    const auto covered = static_cast<double>(part.slice(k)[static_cast<std::ptrdiff_t>(j) * grid.nx + i]);
    for (std::size_t axis = 0; axis < 3; ++axis) sum[axis] += covered * by[axis];
  }
  return sum;
}

/// Of the directions into the faces on both sides, which both have with it.
std::array<double, 3> opening(const std::array<double, 3>& a, const std::array<double, 3>& b) {
  return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}

/// In a strut of an even number of voxels faces seem to open towards its middle, which lies between voxels: there, a
/// voxel on, they open the other way, where those of a wedge go on.
bool is_beside_middle(const model::Volume& part, const Crossing& across, const std::array<double, 3>& opens) {
  std::size_t axis = 0;
  for (std::size_t other = 1; other < 3; ++other)
    if (std::abs(opens[other]) > std::abs(opens[axis])) axis = other;
  Crossing next = across;
  for (auto* at : {&next.near, &next.far}) (*at)[axis] += opens[axis] > 0 ? 1 : -1;
  return opening(inwards(part, next.near), inwards(part, next.far))[axis] * opens[axis] < 0;
}

/// Whether the faces on both sides converge, as at the edge of a wedge, or the way ends far off, as in a cone's tip.
bool tapers(const model::Volume& part, const Crossing& across) {
  if (across.thickness > farthest_of_ball * across.ball + 2) return true;
  const auto a = inwards(part, across.near);
  const auto b = inwards(part, across.far);
  const double lengths = std::hypot(a[0], a[1], a[2]) * std::hypot(b[0], b[1], b[2]);
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2] > widest_cosine * lengths &&
         !is_beside_middle(part, across, opening(a, b));
}

/// In the stretched target and in the print.
struct Thickness {
  double voxels;
  double print_voxels;  // voxels across
  [[nodiscard]] bool operator<(const Thickness& other) const {
    return std::tie(voxels, print_voxels) < std::tie(other.voxels, other.print_voxels);
  }
};

struct Wall {
  Thickness thickness;
  std::int64_t at;
};

/// Of the part's middle.
struct Places {
  std::vector<Wall> walls;
  std::vector<Crossing> tapering;
};

/// A way across, of which the part along z is shorter in the print.
Thickness thickness_of(const Crossing& across, double voxels, double stretch_z) {
  std::array<double, 3> way{};
  for (std::size_t axis = 0; axis < 3; ++axis) way[axis] = across.far[axis] - across.near[axis];
  const double length = std::hypot(way[0], way[1], way[2]);
  return {voxels, voxels * std::hypot(way[0], way[1], way[2] / stretch_z) / length};
}

Places middle_of(const model::Volume& part, const Field& field, double stretch_z) {
  Places all;
  std::mutex mutex;
  parallel_for(field.size[2] - 2, [&](int slice) {
    Places own;
    for (int j = 1; j + 1 < field.size[1]; ++j) {
      for (int i = 1; i + 1 < field.size[0]; ++i) {
        const std::int64_t here = field.index(i, j, slice + 1);
        if (field.solid[here] == 0 || !is_middle(field, i, j, slice + 1)) continue;
        const Crossing across = crossing(field, here);
        if (tapers(part, across)) {
          own.tapering.push_back(across);
        } else {
          own.walls.push_back({thickness_of(across, across.thickness, stretch_z), here});
        }
      }
    }
    const std::lock_guard lock(mutex);
    all.walls.insert(all.walls.end(), own.walls.begin(), own.walls.end());
    all.tapering.insert(all.tapering.end(), own.tapering.begin(), own.tapering.end());
  });
  return all;
}

/// One place may be thin by its steps alone; a strut or a wall has more of them beside it.
std::optional<Wall> thinnest_wall(std::vector<Wall> walls, double usual_voxels, const Field& field) {
  constexpr double steps = 0.75;  // by which places of one wall differ
  constexpr int reach = 2;
  constexpr int fewest = 4;
  const auto before = [](const Wall& a, const Wall& b) { return a.at < b.at; };
  std::erase_if(walls, [&](const Wall& wall) { return wall.thickness.voxels > usual_voxels - accuracy + steps; });
  std::sort(walls.begin(), walls.end(), before);
  const auto confirmed = [&](const Wall& wall) {
    const auto [i, j, k] = field.place(wall.at);
    int found = 0;
    for (int z = std::max(k - reach, 0); z <= std::min(k + reach, field.size[2] - 1); ++z) {
      for (int y = std::max(j - reach, 0); y <= std::min(j + reach, field.size[1] - 1); ++y) {
        const std::int64_t last = field.index(std::min(i + reach, field.size[0] - 1), y, z);
        auto other =
            std::lower_bound(walls.begin(), walls.end(), Wall{{}, field.index(std::max(i - reach, 0), y, z)}, before);
        for (; other != walls.end() && other->at <= last; ++other)
          found += other->thickness.voxels <= wall.thickness.voxels + steps ? 1 : 0;
      }
    }
    return found > fewest;
  };
  const Wall* thinnest = nullptr;
  for (const Wall& wall : walls) {
    const bool thinner =
        thinnest == nullptr ? wall.thickness.voxels <= usual_voxels - accuracy : wall.thickness < thinnest->thickness;
    if (thinner && confirmed(wall)) thinnest = &wall;
  }
  return thinnest == nullptr ? std::nullopt : std::optional(*thinnest);
}

/// Of those that are about as narrow as what does not print.
std::optional<Wall> thinnest_neck(const Field& field, double stretch_z) {
  constexpr std::int32_t most_squared = 6;  // of the way from the middle to the void: 4 voxels across
  constexpr double least_deeper = 1;        // more than voxels make of a strut
  std::vector<std::int32_t> squared(field.solid.size());
  parallel_for(field.size[2], [&](int k) {
    for (std::int64_t at = field.index(0, 0, k); at < field.index(0, 0, k + 1); ++at) {
      if (field.solid[at] != 0) squared[at] = static_cast<std::int32_t>(field.squared(at, field.nearest[at]));
    }
  });
  std::optional<Wall> thinnest;
  for (const std::int64_t at : necks(field.size, squared, most_squared, least_deeper)) {
    const Crossing across = crossing(field, at);
    const Wall neck{thickness_of(across, across.thickness, stretch_z), at};
    if (!thinnest || neck.thickness < thinnest->thickness) thinnest = neck;
  }
  return thinnest;
}

Walls::Place place_of(const Wall& wall, const Field& field, const model::Grid& grid, double stretch_z) {
  const auto [i, j, k] = field.place(wall.at);
  return {wall.thickness.voxels,
          wall.thickness.print_voxels * grid.voxel_mm,
          {grid.x_mm(i - 1), grid.y_mm(j - 1), grid.z_mm(k - 1) / stretch_z}};
}

}  // namespace

Walls walls(const model::Volume& part, double stretch_z) {
  Field field = padded(part);
  find_nearest(field);
  Places places = middle_of(part, field, stretch_z);
  const std::size_t middle = places.walls.size() + places.tapering.size();
  if (middle == 0) return {};
  Thickness thinnest{};
  if (places.walls.empty()) {
    for (const Crossing& across : places.tapering) {
      thinnest = std::max(thinnest, thickness_of(across, across.ball, stretch_z));
    }
  } else {
    std::vector<Thickness> all;
    all.reserve(places.walls.size());
    for (const Wall& wall : places.walls) all.push_back(wall.thickness);
    const auto at = all.begin() + static_cast<std::ptrdiff_t>(thin_share * static_cast<double>(all.size()));
    std::nth_element(all.begin(), at, all.end());
    thinnest = *at;
  }
  const double sharp = std::min(least_printed_voxels, thinnest.voxels - 1);  // the ends of a thin wall are no thinner
  const auto thin = std::count_if(places.tapering.begin(), places.tapering.end(),
                                  [&](const Crossing& across) { return across.thickness < sharp; });
  std::optional<Wall> place = thinnest_wall(std::move(places.walls), thinnest.voxels, field);
  const std::optional<Wall> neck = thinnest_neck(field, stretch_z);
  const bool is_neck_thin = neck && neck->thickness.voxels <= thinnest.voxels - accuracy;
  if (is_neck_thin && (!place || neck->thickness < place->thickness)) place = neck;
  Walls found{thinnest.voxels, thinnest.print_voxels * part.grid.voxel_mm, {}, false};
  if (place) found.thinnest_place = place_of(*place, field, part.grid, stretch_z);
  found.sharp_edges = static_cast<double>(thin) > sharp_share * static_cast<double>(middle);
  return found;
}

}  // namespace vam::solid
