// SPDX-License-Identifier: GPL-3.0-or-later
#include "solid/voxel/voxelize.hpp"

#include <algorithm>
#include <tuple>
#include <vector>

#include "base/compute/parallel.hpp"
#include "solid/voxel/private/clip.hpp"
#include "solid/voxel/private/coverage.hpp"

namespace vam::solid {

namespace {

// Rows of voxels in which solids overlap. The mean winding number of a voxel does not tell its union: twice covered in
// one half is once covered all over.

constexpr int most_pieces = 16;

// Where rays pass across the row, and for which share of its width each stands.
struct Place {
  double at;
  double share;
};

// In the middle of pieces that end where corners are, so that what is linear between these is summed exactly.
std::vector<Place> places(const std::vector<Polygon>& strips, std::size_t axis, int index) {
  constexpr double rounding = 1e-9;
  std::vector<double> ends{double(index), index + 1.0};
  for (const Polygon& strip : strips) {
    for (int c = 0; c < strip.count; ++c) ends.push_back(strip.corners[c][axis]);
  }
  std::sort(ends.begin(), ends.end());
  ends.erase(std::unique(ends.begin(), ends.end(), [](double a, double b) { return b - a < rounding; }), ends.end());
  if (count_of(ends) > most_pieces + 1) ends = {double(index), index + 1.0};
  std::vector<Place> result;
  for (std::size_t e = 0; e + 1 < ends.size(); ++e) {
    const double width = ends[e + 1] - ends[e];
    const int pieces = ceil_int(width * most_pieces - rounding);
    for (int p = 0; p < pieces; ++p) result.push_back({ends[e] + (p + 0.5) * width / pieces, width / pieces});
  }
  return result;
}

// Where a ray along x meets a strip.
struct Hit {
  double x;
  int step;  // of the winding number
};

// The ends of a strip, which is convex, at height z.
struct Crossing {
  double y;
  double x;
  int step;
};
bool crossings(const Polygon& strip, double z, Crossing& left, Crossing& right) {
  int found = 0;
  for (int c = 0; c < strip.count; ++c) {
    const Vector3& p = strip.corners[c];
    const Vector3& q = strip.corners[c + 1 == strip.count ? 0 : c + 1];
    const bool rises = p[2] <= z;
    if (rises == (q[2] <= z)) continue;
    const Vector3& low = rises ? p : q;  // the same point in both triangles that share the edge
    const Vector3& high = rises ? q : p;
    const double t = (z - low[2]) / (high[2] - low[2]);
    const Crossing crossing{low[1] + t * (high[1] - low[1]), low[0] + t * (high[0] - low[0]), rises ? -1 : 1};
    if (found == 0 || crossing.y < left.y) left = crossing;
    if (found == 0 || crossing.y >= right.y) right = crossing;
    ++found;
  }
  return found > 1 && left.y < right.y;
}

// Of the rays at height z, one for each of `ys`, from x = 0 on.
void find_hits(const std::vector<Polygon>& strips, const std::vector<Place>& ys, double z,
               std::vector<std::vector<Hit>>& rays) {
  for (std::vector<Hit>& hits : rays) hits.clear();
  for (const Polygon& strip : strips) {
    Crossing left{};
    Crossing right{};
    if (!crossings(strip, z, left, right)) continue;
    const auto from = std::partition_point(ys.begin(), ys.end(), [&](const Place& y) { return y.at < left.y; });
    for (auto y = from; y != ys.end() && y->at < right.y; ++y) {
      const double t = (y->at - left.y) / (right.y - left.y);
      rays[y - ys.begin()].push_back({left.x + t * (right.x - left.x), right.step});
    }
  }
  for (std::vector<Hit>& hits : rays) {
    std::sort(hits.begin(), hits.end(),
              [](const Hit& a, const Hit& b) { return std::tie(a.x, a.step) < std::tie(b.x, b.step); });
  }
}

// From x on, `amount` more in the prefix sums of a row.
void enter(std::vector<double>& row, double x, double amount) {
  if (amount == 0) return;
  const int last = count_of(row) - 2;
  const int i = std::clamp(floor_int(x), 0, last);
  const double own = std::clamp(i + 1 - x, 0.0, 1.0) * amount;
  row[i] += own;
  row[i + 1] += amount - own;
}

/// Puts the coverage by the union into those voxels of a row that overlapping solids cover in part, and leaves the
/// others. `strips`: the triangles of a closed mesh cut to the row (j, k); `line`: the coverage of its voxels. Along x
/// exact; along y and z at 16 to 32 places between the corners of the strips, and exact for faces along the axes.
void unite_row(const std::vector<Polygon>& strips, int j, int k, int voxels, float* line) {
  const std::vector<Place> ys = places(strips, 1, j);
  const std::vector<Place> zs = places(strips, 2, k);
  std::vector<double> once(static_cast<std::size_t>(voxels) + 1);  // changes of what is covered at all
  std::vector<double> more(once.size());                           // and of what is covered beyond once
  std::vector<std::vector<Hit>> rays(ys.size());
  for (const Place& z : zs) {
    find_hits(strips, ys, z.at, rays);
    for (std::size_t y = 0; y < ys.size(); ++y) {
      const double share = ys[y].share * z.share;
      int winding = 0;
      for (const Hit& hit : rays[y]) {
        const int next = winding + hit.step;
        enter(once, hit.x, share * (std::clamp(next, 0, 1) - std::clamp(winding, 0, 1)));
        enter(more, hit.x, share * (std::max(next - 1, 0) - std::max(winding - 1, 0)));
        winding = next;
      }
    }
  }
  constexpr double rounding = 1e-9;
  double covered = 0;
  double excess = 0;
  for (int i = 0; i < voxels; ++i) {
    covered += once[i];
    if ((excess += more[i]) > rounding) line[i] = settled(covered);
  }
}

// Rows and slices of the grid in which solids may overlap.
struct SharedRows {
  Span y{0, -1};
  Span z{0, -1};

  SharedRows(const Bounds& shared, const model::Grid& grid) {
    const auto span = [&](std::size_t axis, int size) {
      const auto in_voxels = [&](double mm) { return (mm - grid.origin_mm[axis]) / grid.voxel_mm + 0.5; };
      return span_of(in_voxels(shared.low[axis]), in_voxels(shared.high[axis]), size);
    };
    if (shared.low[0] > shared.high[0]) return;
    y = span(1, grid.ny);
    z = span(2, grid.nz);
  }
  [[nodiscard]] bool has(int j, int k) const { return j >= y.first && j <= y.last && k >= z.first && k <= z.last; }
};

// Rows in which solids overlap, by the triangles of the slice that meet them.
void unite_rows(const std::vector<TriangleCorners>& triangles, std::span<const int> members, const model::Grid& grid,
                int k, const std::vector<char>& doubtful, float* out) {
  std::vector<std::vector<Polygon>> strips(doubtful.size());
  for (const int t : members) {
    const Polygon slice = layer(polygon(triangles[t]), 2, k, grid.nz);
    if (slice.count < 3) continue;
    for_each_layer(slice, 1, grid.ny, [&](int j, const Polygon& strip) {
      if (doubtful[j] != 0) strips[j].push_back(strip);
    });
  }
  for (int j = 0; j < grid.ny; ++j) {
    if (doubtful[j] != 0) unite_row(strips[j], j, k, grid.nx, out + static_cast<std::ptrdiff_t>(j) * grid.nx);
  }
}

void slice_exact(const std::vector<TriangleCorners>& triangles, std::span<const int> members, const model::Grid& grid,
                 const SharedRows& shared, int k, VoxelRows& rows, float* out) {
  rows.reset(grid.ny, grid.nx);
  for (const int t : members) {
    const Polygon slice = layer(polygon(triangles[t]), 2, k, grid.nz);
    if (slice.count < 3) continue;
    for_each_layer(slice, 1, grid.ny, [&](int j, const Polygon& strip) {
      double* row = rows[j];
      for_each_layer(strip, 0, grid.nx,
                     [&](int i, const Polygon& piece) { VoxelRows::enter(row, i, moment(piece, 0)); });
    });
  }
  std::vector<char> doubtful(grid.ny, 0);
  for (int j = 0; j < grid.ny; ++j) {
    float* line = out + static_cast<std::ptrdiff_t>(j) * grid.nx;
    if (!rows.touched(j)) {
      std::fill(line, line + grid.nx, 0.0F);
      continue;
    }
    const double* row = rows[j];
    double sum = 0;
    double most = 0;
    for (int i = 0; i < grid.nx; ++i) {
      line[i] = settled(sum += row[i]);
      most = std::max(most, sum);
    }
    constexpr double rounding = 1e-6;
    doubtful[j] = most > 1 + rounding || shared.has(j, k) ? 1 : 0;
  }
  if (std::find(doubtful.begin(), doubtful.end(), 1) != doubtful.end()) {
    unite_rows(triangles, members, grid, k, doubtful, out);
  }
}

}  // namespace

Vote voxelize(const model::TriangleSoup& mesh, const model::Grid& grid, Fill fill, const Bounds& shared,
              const SliceSink& sink) {
  const std::vector<TriangleCorners> triangles = in_voxels(mesh, grid);
  if (fill == Fill::vote) return vote(triangles, grid, sink);
  const Buckets<int> bins = by_layer(triangles, 2, grid.nz);
  const SharedRows shared_rows(shared, grid);
  std::vector<VoxelRows> rows(slab);
  std::vector<float> slices(grid.slice_size() * slab);
  for (int k0 = 0; k0 < grid.nz; k0 += slab) {
    const int count = std::min(slab, grid.nz - k0);
    parallel_for(count, [&](int s) {
      float* out = slices.data() + static_cast<std::size_t>(s) * grid.slice_size();
      slice_exact(triangles, bins[k0 + s], grid, shared_rows, k0 + s, rows[s], out);
    });
    sink(k0, count, slices.data());
  }
  return {};
}

}  // namespace vam::solid
