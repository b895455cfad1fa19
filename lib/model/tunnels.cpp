// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/tunnels.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

#include "base/index.hpp"
#include "base/parallel.hpp"

namespace vam::model {

namespace {

/// Values at the corners of a cell between eight voxels, x fastest, above the level.
using Corners = std::array<float, 8>;
/// Of each corner the least one that it hangs together with in the cell; both are solid, or neither.
using Parts = std::array<int, 8>;

constexpr bool is_solid(float value) { return value >= 0; }

void join(int a, int b, Parts& parts) {
  const int from = std::max(parts[a], parts[b]);
  std::replace(parts.begin(), parts.end(), from, std::min(parts[a], parts[b]));
}

/// By the edges of the cell.
Parts along_edges(const Corners& corners) {
  Parts parts{};
  std::iota(parts.begin(), parts.end(), 0);
  for (int n = 0; n < 8; ++n) {
    for (const int bit : {1, 2, 4}) {
      if ((n & bit) == 0 && is_solid(corners[n]) == is_solid(corners[n | bit])) join(n, n | bit, parts);
    }
  }
  return parts;
}

/// How many there are of the solid, or of the rest.
int count_of(const Parts& parts, const Corners& corners, bool solid) {
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

bool is_ambiguous(const Face& face, const Corners& corners) {
  const bool solid = is_solid(corners[face.a]);
  return is_solid(corners[face.d]) == solid && is_solid(corners[face.b]) != solid && is_solid(corners[face.c]) != solid;
}

/// Whether at its saddle an ambiguous face is solid: its solid corners hang together there, else the others.
bool is_solid_at_saddle(const Face& face, const Corners& corners) {
  const auto value = [&](int corner) { return static_cast<double>(corners[corner]); };
  const double way = value(face.a) * value(face.d) - value(face.b) * value(face.c);
  return is_solid(corners[face.a]) ? way >= 0 : way <= 0;
}

void join_across(const Face& face, const Corners& corners, Parts& parts) {
  if (!is_ambiguous(face, corners)) return;
  const bool first = is_solid(corners[face.a]) == is_solid_at_saddle(face, corners);
  first ? join(face.a, face.d, parts) : join(face.b, face.c, parts);
}

/// Of the solid in a face: its pieces, as none has a hole.
int pieces_of(const Face& face, const Corners& corners) {
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
    way > 0 ? join(end(low.a), end(low.d), parts) : join(end(low.b), end(low.c), parts);
  }
}

/// Of the runs that of this voxel. There is one.
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
void TunnelCounter::add_cell(const std::array<float, 8>& values, double level, int x, int y, Layer& layer) {
  Corners corners{};
  for (int n = 0; n < 8; ++n) corners[n] = static_cast<float>(static_cast<double>(values[n]) - level);
  const Parts edges = along_edges(corners);
  Parts parts = edges;
  int of_cell = 1;
  if (count_of(edges, corners, true) > 1 || count_of(edges, corners, false) > 1) {
    for (std::size_t n = 0; n < low_faces.size(); ++n) {
      const Face& low = low_faces[n];
      const int up = to_high_face[n];
      join_across(low, corners, parts);
      join_across({low.a + up, low.b + up, low.c + up, low.d + up}, corners, parts);
    }
    const int rest_at_faces = count_of(parts, corners, false);
    if (rest_at_faces > 1 || count_of(parts, corners, true) > 1) join_inside(corners, parts);
    of_cell = count_of(parts, corners, true) - (rest_at_faces - count_of(parts, corners, false));
    for (int n = 0; n < 8; ++n) {
      const auto corner = [&](int m) { return Corner{x + (m & 1), y + (m >> 1 & 1), m >= 4}; };
      if (edges[n] == n && parts[n] != n) layer.joins.push_back({corner(parts[n]), corner(n), is_solid(corners[n])});
    }
  }
  layer.euler += of_cell - (is_solid(corners[0]) ? 1 : 0);
  for (const Face& face : low_faces) layer.euler -= pieces_of(face, corners);
  for (const int end : to_high_face) layer.euler += is_solid(corners[0]) || is_solid(corners[end]) ? 1 : 0;
}

/// nullptr: beyond the volume.
TunnelCounter::Layer TunnelCounter::layer(const float* below, const float* above) const {
  Layer made;
  made.solid.assign(product(width_ + 2, height_ + 2), 0);
  const auto value = [&](const float* slice, int x, int y) {  // with the margin
    const bool in = slice != nullptr && x > 0 && x <= width_ && y > 0 && y <= height_;
    return in ? slice[product(y - 1, width_) + static_cast<std::size_t>(x - 1)] : 0.0F;
  };
  const auto reaches = [this](float v) { return static_cast<double>(v) >= level_; };
  for (int y = 0; y <= height_; ++y) {
    Corners corners{};
    for (int x = -1; x <= width_; ++x) {
      int solid = 0;
      for (int n = 0; n < 8; n += 2) {
        corners[n] = corners[n + 1];
        corners[n + 1] = value(n < 4 ? below : above, x + 1, y + (n >> 1 & 1));
        solid += (reaches(corners[n]) ? 1 : 0) + (reaches(corners[n + 1]) ? 1 : 0);
      }
      made.solid[product(y, width_ + 2) + static_cast<std::size_t>(x + 1)] = reaches(corners[5]) ? 1 : 0;
      if (solid > 0 && solid < 8) add_cell(corners, level_, x, y, made);
    }
  }
  return made;
}

void TunnelCounter::add(int count, const float* slices) {
  if (count == 0) return;
  const std::size_t size = product(width_, height_);
  const std::size_t first = added_.size();
  added_.resize(first + static_cast<std::size_t>(count));
  const float* before = last_.empty() ? nullptr : last_.data();
  parallel_for(count, [&](int k) {
    added_[first + static_cast<std::size_t>(k)] =
        layer(k > 0 ? slices + product(k - 1, size) : before, slices + product(k, size));
  });
  const float* last = slices + product(count - 1, size);
  last_ = std::vector<float>(last, last + size);
}

/// The corners of joins lie in these runs and in those of the slice before.
void TunnelCounter::Pieces::add(const std::vector<VoxelRun>& runs, const std::vector<Join>& joins, bool solid) {
  const std::vector<VoxelRun> below = sets.last();
  sets.add(runs, by_faces_only);
  const std::size_t first = sets.first_of_last();
  for (const Join& join : joins) {
    if (join.solid != solid) continue;
    const auto number = [&](const Corner& at) {
      return at.above ? first + run_of(runs, at.x, at.y) : first - below.size() + run_of(below, at.x, at.y);
    };
    sets.join(number(join.from), number(join.to));
  }
  sets.forget([this](std::size_t) { ++complete; });
}

std::int64_t TunnelCounter::Pieces::count() const {
  std::int64_t all = complete;
  for (std::size_t run = 0; run < sets.runs(); ++run) all += sets.set_of(run) == run ? 1 : 0;
  return all;
}

void TunnelCounter::connect(const Layer& layer) {
  euler_ += layer.euler;
  for (const bool solid : {true, false}) {
    const auto runs = runs_of(width_ + 2, height_ + 2, [&](std::size_t i) { return (layer.solid[i] != 0) == solid; });
    (solid ? solid_ : rest_).add(runs, layer.joins, solid);
  }
}

void TunnelCounter::connect() {
  if (rest_.sets.runs() == 0) {  // what lies below the volume
    const Layer margin{std::vector<std::uint8_t>(product(width_ + 2, height_ + 2), 0), {}, 0};
    connect(margin);
  }
  for (const Layer& layer : std::exchange(added_, {})) connect(layer);
}

std::int64_t TunnelCounter::tunnels() const {
  if (last_.empty()) return 0;
  TunnelCounter all = *this;
  all.connect(layer(last_.data(), nullptr));
  return all.solid_.count() + all.rest_.count() - 1 - all.euler_;
}

}  // namespace vam::model
