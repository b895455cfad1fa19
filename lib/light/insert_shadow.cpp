#include "light/insert_shadow.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "base/error.hpp"
#include "base/parallel.hpp"

namespace vam::light {

namespace {

constexpr double never = std::numeric_limits<double>::infinity();

/// A ray along one axis, in voxels: voxel i lies between i and i + 1.
struct Axis {
  double start, rate;

  /// Stretch of u in which the ray is between two faces.
  [[nodiscard]] std::pair<double, double> between(int low, int high) const {
    if (rate == 0) return start > low && start < high ? std::pair{-never, never} : std::pair{never, -never};
    const double a = (low - start) / rate;
    const double b = (high - start) / rate;
    return {std::min(a, b), std::max(a, b)};
  }
  [[nodiscard]] int voxel(double u, int low, int high) const {
    return std::clamp(static_cast<int>(std::floor(start + u * rate)), low, high - 1);
  }
  /// u at which it leaves the voxel.
  [[nodiscard]] double leaves(int voxel) const {
    if (rate == 0) return never;
    return (voxel + (rate > 0 ? 1 : 0) - start) / rate;
  }
  [[nodiscard]] int step() const { return rate > 0 ? 1 : -1; }
};

}  // namespace

/// An insert and the box around it: voxels [x0, x1) x [y0, y1).
struct InsertShadow::Opaque {
  const Image& coverage;
  int x0, x1, y0, y1;

  explicit Opaque(const Image& image) : coverage(image), x0(image.width), x1(0), y0(image.height), y1(0) {
    for (int y = 0; y < image.height; ++y) {
      for (int x = 0; x < image.width; ++x) {
        if (!at(x, y)) continue;
        x0 = std::min(x0, x);
        x1 = std::max(x1, x + 1);
        y0 = std::min(y0, y);
        y1 = std::max(y1, y + 1);
      }
    }
  }
  [[nodiscard]] bool at(int x, int y) const { return opaque(coverage(x, y)); }
  [[nodiscard]] bool same(const Image& other) const {
    return std::equal(coverage.values.begin(), coverage.values.end(), other.values.begin(),
                      [](float a, float b) { return opaque(a) == opaque(b); });
  }
};

InsertShadow::InsertShadow(const model::Grid& grid, std::span<const double> angles_rad,
                           std::span<const RayLine> columns)
    : grid_(grid), lines_(columns.begin(), columns.end()) {
  for (const double theta : angles_rad) rows_.push_back({std::cos(theta), std::sin(theta)});
  for (const RayLine& line : lines_) columns_.push_back({std::cos(line.delta_rad), std::sin(line.delta_rad)});
  ends_.assign(at(static_cast<int>(rows_.size()), 0), unhindered);
}

void InsertShadow::cast(std::span<const Image> inserts) {
  std::fill(ends_.begin(), ends_.end(), unhindered);
  for (std::size_t s = 0; s < inserts.size(); ++s) {
    const Image& insert = inserts[s];
    if (insert.width != grid_.nx || insert.height != grid_.ny) {
      throw Error{Fault::data, "insert: a slice has " + std::to_string(insert.width) + " x " +
                                   std::to_string(insert.height) + " voxels, the dose " + std::to_string(grid_.nx) +
                                   " x " + std::to_string(grid_.ny)};
    }
    const Opaque body(insert);
    const bool repeated = s > 0 && body.same(inserts[s - 1]);
    parallel_for(static_cast<int>(rows_.size()), [&](int row) {
      for (int c = 0; c < static_cast<int>(lines_.size()); ++c) {
        float* end = ends_.data() + at(row, c) + s;
        *end = repeated ? end[-1] : follow(body, row, c);
      }
    });
  }
}

/// Voxel by voxel [Amanatides & Woo 1987], u in voxels on the way.
float InsertShadow::follow(const Opaque& insert, int row, int column) const {
  const RayLine& line = lines_[static_cast<std::size_t>(column)];
  if (!line.hits || insert.x1 == 0) return unhindered;
  const Direction& part = rows_[static_cast<std::size_t>(row)];
  const Direction& ray = columns_[static_cast<std::size_t>(column)];
  const double c = part.cosine * ray.cosine - part.sine * ray.sine;
  const double s = part.sine * ray.cosine + part.cosine * ray.sine;
  const Axis along_x{(line.offset_mm * c - grid_.origin_mm[0]) / grid_.voxel_mm + 0.5, -s};
  const Axis along_y{(line.offset_mm * s - grid_.origin_mm[1]) / grid_.voxel_mm + 0.5, c};
  const auto [x_in, x_out] = along_x.between(insert.x0, insert.x1);
  const auto [y_in, y_out] = along_y.between(insert.y0, insert.y1);
  double u = std::max(x_in, y_in);
  if (!(u < std::min(x_out, y_out))) return unhindered;
  int x = along_x.voxel(u, insert.x0, insert.x1);
  int y = along_y.voxel(u, insert.y0, insert.y1);
  while (x >= insert.x0 && x < insert.x1 && y >= insert.y0 && y < insert.y1) {
    if (insert.at(x, y)) return static_cast<float>(u * grid_.voxel_mm);
    const double leaves_x = along_x.leaves(x);
    const double leaves_y = along_y.leaves(y);
    u = std::min(leaves_x, leaves_y);
    if (leaves_x < leaves_y) {
      x += along_x.step();
    } else {
      y += along_y.step();
    }
  }
  return unhindered;
}

void darken(std::span<const Image> inserts, std::span<Image> doses) {
  for (std::size_t s = 0; s < doses.size(); ++s) {
    for (std::size_t p = 0; p < doses[s].size(); ++p) {
      if (opaque(inserts[s].values[p])) doses[s].values[p] = 0;
    }
  }
}

}  // namespace vam::light
