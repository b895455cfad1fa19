// SPDX-License-Identifier: GPL-3.0-or-later
#include "verdict/private/field_shape.hpp"

#include <algorithm>
#include <bit>
#include <iterator>
#include <numeric>
#include <utility>

#include "base/compute/parallel.hpp"
#include "base/index.hpp"

namespace vam::verdict {

namespace {

/// Values at the corners of a cell between eight voxels, x fastest, above the level.
using Corners = std::array<float, 8>;
/// For each corner, the least one that it is connected with in the cell; both are solid, or neither.
using Parts = std::array<int, 8>;

constexpr bool is_solid(float value) { return value >= 0; }

constexpr void connect_parts(int a, int b, Parts& parts) {
  const int from = std::max(parts[a], parts[b]);
  std::replace(parts.begin(), parts.end(), from, std::min(parts[a], parts[b]));
}

constexpr Parts along_edges(const Corners& corners) {
  Parts parts{};
  std::iota(parts.begin(), parts.end(), 0);
  for (int n = 0; n < 8; ++n) {
    for (const int bit : {1, 2, 4}) {
      if ((n & bit) == 0 && is_solid(corners[n]) == is_solid(corners[n | bit])) connect_parts(n, n | bit, parts);
    }
  }
  return parts;
}

/// How many there are of the solid, or of the rest.
constexpr int parts_of(const Parts& parts, const Corners& corners, bool solid) {
  int count = 0;
  for (int n = 0; n < 8; ++n) count += parts[n] == n && is_solid(corners[n]) == solid ? 1 : 0;
  return count;
}

/// Corners a and d of a face, and b and c, are opposite.
struct Face {
  int a, b, c, d;
};
constexpr std::array<Face, 3> low_faces{{{0, 2, 4, 6}, {0, 1, 4, 5}, {0, 1, 2, 3}}};
constexpr std::array<int, 3> to_high_face{1, 2, 4};

constexpr bool is_ambiguous(const Face& face, const Corners& corners) {
  const bool solid = is_solid(corners[face.a]);
  return is_solid(corners[face.d]) == solid && is_solid(corners[face.b]) != solid && is_solid(corners[face.c]) != solid;
}

/// Whether at its saddle an ambiguous face is solid: its solid corners hang together there, else the others.
constexpr bool is_solid_at_saddle(const Face& face, const Corners& corners) {
  const auto value = [&](int corner) { return static_cast<double>(corners[corner]); };
  const double way = value(face.a) * value(face.d) - value(face.b) * value(face.c);
  return is_solid(corners[face.a]) ? way >= 0 : way <= 0;
}

void join_across(const Face& face, const Corners& corners, Parts& parts) {
  if (!is_ambiguous(face, corners)) return;
  const bool first = is_solid(corners[face.a]) == is_solid_at_saddle(face, corners);
  first ? connect_parts(face.a, face.d, parts) : connect_parts(face.b, face.c, parts);
}

/// Pieces of the solid in a face; none has a hole.
constexpr int pieces_of(const Face& face, const Corners& corners) {
  if (is_ambiguous(face, corners) && !is_solid_at_saddle(face, corners)) return 2;
  return is_solid(corners[face.a]) || is_solid(corners[face.b]) || is_solid(corners[face.c]) ||
                 is_solid(corners[face.d])
             ? 1
             : 0;
}

/// Joins what hangs together inside the cell [CHE95]: where a section between two opposite faces has two opposite
/// corners that hang together at its saddle, as neither face may have.
void join_inside(const Corners& corners, Parts& parts) {
  for (std::size_t axis = 0; axis < low_faces.size(); ++axis) {
    const Face& low = low_faces[axis];
    const int up = to_high_face[axis];
    const auto at = [&](int corner, double t) {
      return (1 - t) * static_cast<double>(corners[corner]) + t * static_cast<double>(corners[corner + up]);
    };
    // a d - b c along the axis, a quadratic, at its extremum.
    const auto rise = [&](int corner) { return at(corner, 1) - at(corner, 0); };
    const double bend = rise(low.a) * rise(low.d) - rise(low.b) * rise(low.c);
    const double slope = at(low.a, 0) * rise(low.d) + rise(low.a) * at(low.d, 0) - at(low.b, 0) * rise(low.c) -
                         rise(low.b) * at(low.c, 0);
    if (bend == 0) continue;
    const double t = -slope / (2 * bend);
    if (!(t > 0 && t < 1)) continue;
    const bool solid = at(low.a, t) >= 0;
    const auto is = [&](int corner) { return at(corner, t) >= 0; };
    if (is(low.d) != solid || is(low.b) == solid || is(low.c) == solid) continue;
    const double way = at(low.a, t) * at(low.d, t) - at(low.b, t) * at(low.c, t);
    if (way * bend >= 0) continue;  // as at the faces
    const auto end = [&](int corner) { return is_solid(corners[corner]) == is(corner) ? corner : corner + up; };
    way > 0 ? connect_parts(end(low.a), end(low.d), parts) : connect_parts(end(low.b), end(low.c), parts);
  }
}

/// Contribution of a cell to the Euler characteristic, with the faces, edges and corner at its low sides. of_cell:
/// pieces of its solid, less tunnels.
constexpr int euler_of(int of_cell, const Corners& corners) {
  int euler = of_cell - (is_solid(corners[0]) ? 1 : 0);
  for (const Face& face : low_faces) euler -= pieces_of(face, corners);
  for (const int end : to_high_face) euler += is_solid(corners[0]) || is_solid(corners[end]) ? 1 : 0;
  return euler;
}

/// A plain cell is cut by one surface, which meets no face twice: its solid corners determine its contribution.
struct Cut {
  bool is_plain = false;
  int euler = 0;
};

/// Index: the solid corners, as bits.
constexpr std::array<Cut, 256> cuts = [] {
  std::array<Cut, 256> all{};
  for (unsigned solid = 0; solid < all.size(); ++solid) {
    Corners corners{};
    for (unsigned n = 0; n < 8; ++n) corners[n] = (solid >> n & 1U) != 0 ? 1.0F : -1.0F;
    const Parts parts = along_edges(corners);
    all[solid].is_plain = parts_of(parts, corners, true) <= 1 && parts_of(parts, corners, false) <= 1;
    for (const Face& face : low_faces) all[solid].is_plain = all[solid].is_plain && !is_ambiguous(face, corners);
    all[solid].euler = euler_of(1, corners);
  }
  return all;
}();

/// visit(x) of the cells between columns x and x + 1, rows y and y + 1 of two slices that have corners of both kinds.
template <class Visit>
void for_cut_cells(const BitSlice& low, const BitSlice& high, int y, const Visit& visit) {
  const std::array<const BitSlice::Word*, 4> rows{low.row(y), low.row(y + 1), high.row(y), high.row(y + 1)};
  const auto all = [&](int n) { return rows[0][n] & rows[1][n] & rows[2][n] & rows[3][n]; };
  const auto any = [&](int n) { return rows[0][n] | rows[1][n] | rows[2][n] | rows[3][n]; };
  for (int n = 0; n < low.words(); ++n) {
    // Bits with the next higher ones, the first of the next word for the last of this one.
    const auto with_next = [&](const auto& of) {
      return std::pair{of(n), of(n) >> 1U | (n + 1 < low.words() ? of(n + 1) << (BitSlice::word_bits - 1) : 0)};
    };
    const auto [all_here, all_there] = with_next(all);
    const auto [any_here, any_there] = with_next(any);
    for (BitSlice::Word cut = (any_here | any_there) & ~(all_here & all_there); cut != 0; cut &= cut - 1) {
      const int x = n * BitSlice::word_bits + std::countr_zero(cut) - 1;
      if (x < low.width()) visit(x);
    }
  }
}

/// The run that holds this voxel. There is one.
std::size_t run_of(const std::vector<VoxelRun>& runs, int x, int y) {
  const auto after =
      std::upper_bound(runs.begin(), runs.end(), std::pair{y, x}, [](const auto& at, const VoxelRun& run) {
        return at < std::pair{run.row, run.begin};
      });
  return static_cast<std::size_t>(after - runs.begin()) - 1;
}

}  // namespace

/// The Euler characteristic is the sum of those of cells - faces + edges - corners: a cell brings those that it has at
/// its low sides. Within a cell it is pieces - tunnels, which are what the rest joins inside.
void FieldCounter::add_cell(const std::array<float, 8>& values, double level, int x, int y, Layer& layer) {
  Corners corners{};
  for (int n = 0; n < 8; ++n) corners[n] = static_cast<float>(static_cast<double>(values[n]) - level);
  const Parts edges = along_edges(corners);
  Parts parts = edges;
  int of_cell = 1;
  if (parts_of(edges, corners, true) > 1 || parts_of(edges, corners, false) > 1) {
    for (std::size_t n = 0; n < low_faces.size(); ++n) {
      const Face& low = low_faces[n];
      const int up = to_high_face[n];
      join_across(low, corners, parts);
      join_across({low.a + up, low.b + up, low.c + up, low.d + up}, corners, parts);
    }
    const int rest_at_faces = parts_of(parts, corners, false);
    if (rest_at_faces > 1 || parts_of(parts, corners, true) > 1) join_inside(corners, parts);
    of_cell = parts_of(parts, corners, true) - (rest_at_faces - parts_of(parts, corners, false));
    for (int n = 0; n < 8; ++n) {
      const auto corner = [&](int m) { return Corner{x + (m & 1), y + (m >> 1 & 1), m >= 4}; };
      if (edges[n] == n && parts[n] != n) layer.joins.push_back({corner(parts[n]), corner(n), is_solid(corners[n])});
    }
  }
  layer.euler += euler_of(of_cell, corners);
}

/// Cells with a corner that is solid and one that is not. nullptr: beyond the volume.
FieldCounter::Layer FieldCounter::layer(const float* below, const float* above) const {
  const auto bits = [this](const float* slice) {
    return slice == nullptr ? BitSlice(width_, height_) : reaching(width_, height_, slice, level_);
  };
  const BitSlice low = bits(below);
  Layer made{bits(above), {}, 0};
  const auto value = [&](const float* slice, int x, int y) {
    const bool in = slice != nullptr && x >= 0 && x < width_ && y >= 0 && y < height_;
    return in ? slice[product(y, width_) + static_cast<std::size_t>(x)] : 0.0F;
  };
  const auto add = [&](int x, int y) {
    const unsigned solid = low.some(x, y, 2) | low.some(x, y + 1, 2) << 2U | made.solid.some(x, y, 2) << 4U |
                           made.solid.some(x, y + 1, 2) << 6U;
    const Cut& cut = cuts[solid];
    if (cut.is_plain) {
      made.euler += cut.euler;
      return;
    }
    Corners values{};
    for (int n = 0; n < 8; ++n) values[n] = value(n < 4 ? below : above, x + (n & 1), y + (n >> 1 & 1));
    add_cell(values, level_, x, y, made);
  };
  for (int y = -1; y < height_; ++y) for_cut_cells(low, made.solid, y, [&](int x) { add(x, y); });
  return made;
}

void FieldCounter::add(int count, const float* slices) {
  if (count == 0) return;
  const std::size_t size = product(width_, height_);
  std::vector<Layer> layers(count, Layer{BitSlice(width_, height_), {}, 0});
  const float* before = last_.empty() ? nullptr : last_.data();
  parallel_for(count, [&](int k) {
    layers[k] = layer(k > 0 ? slices + product(k - 1, size) : before, slices + product(k, size));
  });
  std::move(layers.begin(), layers.end(), std::back_inserter(added_));
  const float* last = slices + product(count - 1, size);
  last_ = std::vector<float>(last, last + size);
}

void FieldCounter::connect(const Layer& layer) {
  euler_ += layer.euler;
  for (const bool solid : {true, false}) {
    (solid ? solid_ : rest_)
        .add(layer.solid.runs(solid, !solid), Touching::faces, [&](RunSets& sets, const std::vector<VoxelRun>& before) {
          const std::size_t first = sets.first_of_last();
          const auto number = [&](const Corner& at) {
            return at.above ? first + run_of(sets.last(), at.x, at.y)
                            : first - before.size() + run_of(before, at.x, at.y);
          };
          for (const Join& join : layer.joins)
            if (join.solid == solid) sets.join(number(join.from), number(join.to));
        });
  }
}

void FieldCounter::connect() {
  if (!std::exchange(begun_, true)) connect(Layer{BitSlice(width_, height_), {}, 0});
  for (const Layer& layer : std::exchange(added_, {})) connect(layer);
}

FieldShape FieldCounter::found() const {
  if (last_.empty()) return {};
  FieldCounter all = *this;
  all.connect(layer(last_.data(), nullptr));
  return {all.solid_.large(), all.solid_.all() + all.rest_.all() - 1 - all.euler_};
}

}  // namespace vam::verdict
