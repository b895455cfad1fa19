#include "solid/voxelize.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <vector>

#include "base/error.hpp"
#include "base/parallel.hpp"
#include "solid/clip.hpp"

namespace vam::solid {

namespace {

// Residues of cancelling sums are below 1e-9 of a voxel for a million triangles; true coverage this close to 0 or 1
// makes no difference to a dose, and snapping keeps void and interior exact.
constexpr double snap = 1e-6;

float settled(double sum) {
  const double coverage = std::abs(sum);
  if (coverage < snap) return 0;
  if (coverage > 1 - snap) return 1;
  return static_cast<float>(coverage);
}

using Corners = std::array<Vector3, 3>;

// The mesh in voxel units, and for every layer along one axis the triangles that meet it, in ascending order.
class Bins {
 public:
  Bins(const std::vector<Corners>& triangles, std::size_t axis, int layers)
      : first_(static_cast<std::size_t>(layers) + 1) {
    std::vector<Span> spans;
    spans.reserve(triangles.size());
    for (const Corners& t : triangles) {
      const auto [low, high] = std::minmax({t[0][axis], t[1][axis], t[2][axis]});
      spans.push_back(span_of(low, high, layers));
      for (int k = spans.back().first; k <= spans.back().last; ++k) ++first_[static_cast<std::size_t>(k) + 1];
    }
    for (std::size_t k = 1; k < first_.size(); ++k) first_[k] += first_[k - 1];
    std::vector<std::size_t> next(first_.begin(), first_.end() - 1);
    members_.resize(first_.back());
    for (std::size_t t = 0; t < triangles.size(); ++t) {
      for (int k = spans[t].first; k <= spans[t].last; ++k)
        members_[next[static_cast<std::size_t>(k)]++] = static_cast<int>(t);
    }
  }
  [[nodiscard]] std::span<const int> operator[](int layer) const {
    const auto k = static_cast<std::size_t>(layer);
    return std::span<const int>(members_).subspan(first_[k], first_[k + 1] - first_[k]);
  }

 private:
  std::vector<std::size_t> first_;
  std::vector<int> members_;
};

std::vector<Corners> in_voxels(const model::TriangleSoup& mesh, const model::Grid& grid) {
  const std::array<int, 3> size{grid.nx, grid.ny, grid.nz};
  std::vector<Vector3> points(mesh.points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (std::size_t a = 0; a < 3; ++a) {
      points[i][a] = (mesh.points[i][a] - grid.origin_mm[a]) / grid.voxel_mm + 0.5;
    }
  }
  std::vector<Corners> triangles;
  triangles.reserve(mesh.triangles.size());
  constexpr double rounding = 1e-6;
  for (const auto& triangle : mesh.triangles) {
    Corners corners{};
    for (std::size_t c = 0; c < 3; ++c) {
      corners[c] = points[static_cast<std::size_t>(triangle[c])];
      for (std::size_t a = 0; a < 3; ++a) {
        if (!(corners[c][a] > -rounding && corners[c][a] < size[a] + rounding)) {
          throw Error{Fault::bug, "voxelize: the mesh leaves its grid"};
        }
      }
    }
    triangles.push_back(corners);
  }
  return triangles;
}

Polygon polygon(const Corners& corners) {
  Polygon result;
  for (const Vector3& corner : corners) result.add(corner);
  return result;
}

// Sums of one axis over a piece: the component of its vector area along the axis, and that times its mean coordinate.
struct Moment {
  double area = 0;
  double first = 0;
};
Moment moment(const Polygon& piece, std::size_t axis) {
  const std::size_t u = (axis + 1) % 3;
  const std::size_t v = (axis + 2) % 3;
  const Vector3& a = piece.corners[0];
  Moment result;
  for (int i = 1; i + 1 < piece.count; ++i) {
    const Vector3& b = piece.corners[static_cast<std::size_t>(i)];
    const Vector3& c = piece.corners[static_cast<std::size_t>(i) + 1];
    const double area = 0.5 * ((b[u] - a[u]) * (c[v] - a[v]) - (b[v] - a[v]) * (c[u] - a[u]));
    result.area += area;
    result.first += area * (a[axis] + b[axis] + c[axis]) / 3;
  }
  return result;
}

// Enters a piece into a row: own voxel by its share, the next by the rest; the prefix sum carries it on.
void enter(double* row, int index, const Moment& m) {
  const double behind = (index + 1) * m.area - m.first;
  row[index] -= behind;
  row[index + 1] -= m.area - behind;
}

// Rows of a slice with one entry more than there are voxels. Only touched rows are cleared.
struct Rows {
  int length = 0;
  std::vector<double> values;
  std::vector<char> touched;

  void reset(int rows, int voxels) {
    length = voxels + 1;
    values.resize(static_cast<std::size_t>(rows) * static_cast<std::size_t>(length));
    touched.assign(static_cast<std::size_t>(rows), 0);
  }
  double* row(int index) {
    double* begin = values.data() + static_cast<std::ptrdiff_t>(index) * length;
    if (touched[static_cast<std::size_t>(index)] == 0) {
      touched[static_cast<std::size_t>(index)] = 1;
      std::fill(begin, begin + length, 0.0);
    }
    return begin;
  }
  // Prefix sums in place; returns the row's total, nothing where no triangle came by.
  double accumulate(int index) {
    double* entry = row(index);
    double sum = 0;
    for (int i = 0; i < length; ++i) entry[i] = sum += entry[i];
    return sum;
  }
};

void slice_exact(const std::vector<Corners>& triangles, std::span<const int> members, const model::Grid& grid, int k,
                 Rows& rows, float* out) {
  rows.reset(grid.ny, grid.nx);
  for (const int t : members) {
    const Corners& corners = triangles[static_cast<std::size_t>(t)];
    const Polygon slice = layer(polygon(corners), 2, k, grid.nz);
    if (slice.count < 3) continue;
    for_each_layer(slice, 1, grid.ny, [&](int j, const Polygon& strip) {
      double* row = rows.row(j);
      for_each_layer(strip, 0, grid.nx, [&](int i, const Polygon& piece) { enter(row, i, moment(piece, 0)); });
    });
  }
  for (int j = 0; j < grid.ny; ++j) {
    float* line = out + static_cast<std::ptrdiff_t>(j) * grid.nx;
    if (rows.touched[static_cast<std::size_t>(j)] == 0) {
      std::fill(line, line + grid.nx, 0.0F);
      continue;
    }
    const double* row = rows.row(j);
    double sum = 0;
    for (int i = 0; i < grid.nx; ++i) line[i] = settled(sum += row[i]);
  }
}

}  // namespace

Vote voxelize(const model::TriangleSoup& mesh, const model::Grid& grid, Fill fill, const SliceSink& sink) {
  const std::vector<Corners> triangles = in_voxels(mesh, grid);
  const Bins bins(triangles, 2, grid.nz);
  std::vector<Rows> rows(slab);
  std::vector<float> slices(grid.slice_size() * slab);
  for (int k0 = 0; k0 < grid.nz; k0 += slab) {
    const int count = std::min(slab, grid.nz - k0);
    parallel_for(count, [&](int s) {
      float* out = slices.data() + static_cast<std::size_t>(s) * grid.slice_size();
      slice_exact(triangles, bins[k0 + s], grid, k0 + s, rows[static_cast<std::size_t>(s)], out);
    });
    sink(k0, count, slices.data());
  }
  return {};
}

}  // namespace vam::solid
