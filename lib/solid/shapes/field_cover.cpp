// The coverage of voxels by a solid that is a function.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "base/parallel.hpp"
#include "solid/shapes/field.hpp"

namespace vam::solid {

double cube_fraction(double offset, const Point& normal) {
  std::array<double, 3> m{std::abs(normal[0]), std::abs(normal[1]), std::abs(normal[2])};
  std::sort(m.begin(), m.end());
  const double sum = m[0] + m[1] + m[2];
  const double level = 0.5 - offset / sum;  // share of the way from the first corner to the last
  if (level <= 0) return 0;
  if (level >= 1) return 1;
  const double a = std::min(level, 1 - level);
  const double m1 = std::max(m[0] / sum, 1e-7);  // floors against 0/0; they change the result by less than 1e-7
  const double m2 = std::max(m[1] / sum, 1e-7);
  const double m3 = m[2] / sum;
  const double m12 = m1 + m2;
  const auto cap = [a](double side) { return side * side * (side - 3 * a); };
  double volume = 0;
  if (a < m1) {
    volume = a * a * a / (6 * m1 * m2 * m3);
  } else if (a < m2) {
    volume = a * (a - m1) / (2 * m2 * m3) + m1 * m1 / (6 * m2 * m3);
  } else if (a < std::min(m12, m3)) {
    volume = (a * a * (3 * m12 - a) + cap(m1) + cap(m2)) / (6 * m1 * m2 * m3);
  } else if (m3 < m12) {
    volume = (a * a * (3 - 2 * a) + cap(m1) + cap(m2) + cap(m3)) / (6 * m1 * m2 * m3);
  } else {
    volume = (2 * a - m12) / (2 * m3);
  }
  volume = std::clamp(volume, 0.0, 0.5);
  return level <= 0.5 ? volume : 1 - volume;
}

namespace {

constexpr int block = 4;    // voxels along the edge of a block
constexpr int deepest = 3;  // halvings of a voxel
// Departure from a linear field, relative to its change across the cell. Smooth curvature shows up as an even residual
// of at most a quarter of the curvature times the edge, which the mean value of the cell accounts for; edges show
// more, and an edge anywhere but in the middle has an odd part.
constexpr double even_least = 0.01;
constexpr double even_most = 0.04;
constexpr double odd_limit = 0.01;
constexpr double half_diagonal = 0.8660254037844386;  // of a unit cube
constexpr double slack = 1.05;  // numerically projected distances (gyroid) are Lipschitz to a few per cent

// Corner c of a cell: bit a of c tells the side along axis a.
using Corners = std::array<double, 8>;

Point corner_sign(unsigned c) {
  return {(c & 1U) != 0 ? 0.5 : -0.5, (c & 2U) != 0 ? 0.5 : -0.5, (c & 4U) != 0 ? 0.5 : -0.5};
}

double cell_fraction(const Field& field, const Point& centre, double edge_mm, const Corners& corners, int depth);

// The field at a cell's corners as a plane and what is left.
struct Fit {
  double mean = 0;
  Point slope{};    // change of the field across the cell along each axis
  double even = 0;  // largest residual that is the same at opposite corners, the cell's middle included
  double odd = 0;   // largest residual that changes its sign

  Fit(const Corners& corners, double middle) {
    for (unsigned c = 0; c < 8; ++c) {
      mean += corners[c] / 8;
      slope = slope + (corners[c] / 2) * corner_sign(c);
    }
    Corners residual{};
    for (unsigned c = 0; c < 8; ++c) residual[c] = corners[c] - mean - dot(slope, corner_sign(c));
    even = std::abs(middle - mean);
    for (unsigned c = 0; c < 4; ++c) {
      even = std::max(even, 0.5 * std::abs(residual[c] + residual[7 - c]));
      odd = std::max(odd, 0.5 * std::abs(residual[c] - residual[7 - c]));
    }
  }
};

// The mean over the cell's eight parts.
double halved_fraction(const Field& field, const Point& centre, double edge_mm, const Corners& corners, double middle,
                       int depth) {
  // Nodes of the eight parts, 3 x 3 x 3: the corners and the middle are known.
  std::array<double, 27> nodes{};
  for (unsigned n = 0; n < 27; ++n) {
    const unsigned i = n % 3;
    const unsigned j = n / 3 % 3;
    const unsigned k = n / 9;
    const bool corner = i != 1 && j != 1 && k != 1;
    nodes[n] = corner    ? corners[i / 2 + j / 2 * 2 + k / 2 * 4]
               : n == 13 ? middle
                         : field.value(centre + (edge_mm / 2) * Point{i - 1.0, j - 1.0, k - 1.0});
  }
  double fraction = 0;
  for (unsigned part = 0; part < 8; ++part) {
    const unsigned first = (part & 1U) + 3 * (part >> 1U & 1U) + 9 * (part >> 2U);
    Corners part_corners{};
    for (unsigned c = 0; c < 8; ++c) part_corners[c] = nodes[first + (c & 1U) + 3 * (c >> 1U & 1U) + 9 * (c >> 2U)];
    fraction +=
        cell_fraction(field, centre + (edge_mm / 2) * corner_sign(part), edge_mm / 2, part_corners, depth + 1) / 8;
  }
  return fraction;
}

double cell_fraction(const Field& field, const Point& centre, double edge_mm, const Corners& corners, int depth) {
  const double middle = field.value(centre);
  if (std::abs(middle) > slack * field.lipschitz * half_diagonal * edge_mm) return middle < 0 ? 1 : 0;
  const Fit fit(corners, middle);
  const double steepness = length(fit.slope);
  const double even_limit = std::clamp(0.3 * field.curvature_per_mm * edge_mm, even_least, even_most);
  const bool smooth = fit.even <= even_limit * steepness && fit.odd <= odd_limit * steepness;
  if (!smooth && depth < deepest) return halved_fraction(field, centre, edge_mm, corners, middle, depth);
  if (!smooth) {
    // What an edge makes of a plane fitted to it must not cut corners that are all on one side.
    const auto [low, high] = std::minmax_element(corners.begin(), corners.end());
    if (*high <= 0 && middle <= 0) return 1;
    if (*low >= 0 && middle >= 0) return 0;
  }
  if (steepness == 0) return middle < 0 ? 1 : 0;
  // The mean over the cell of a field that is quadratic: two thirds centre, one third corners.
  return cube_fraction((2 * middle + fit.mean) / 3, fit.slope);
}

struct Span {
  int begin;
  int end;
};

// Voxels of one block [x) x [y) x [z), z relative to k0.
struct Block {
  Span x, y, z;
};

// Whether the surface stays clear of the block, which then is all part (-1) or all void (1); 0: it may not.
int side_of(const Field& field, const model::Grid& grid, int k0, const Block& b) {
  const double h = grid.voxel_mm;
  const Point centre{grid.x_mm(0.5 * (b.x.begin + b.x.end - 1)), grid.y_mm(0.5 * (b.y.begin + b.y.end - 1)),
                     grid.z_mm(k0 + 0.5 * (b.z.begin + b.z.end - 1))};
  const Point half{0.5 * h * (b.x.end - b.x.begin), 0.5 * h * (b.y.end - b.y.begin), 0.5 * h * (b.z.end - b.z.begin)};
  const double whole = field.value(centre);
  if (std::abs(whole) <= slack * field.lipschitz * length(half)) return 0;
  return whole < 0 ? -1 : 1;
}

// The field at the corners of a block's voxels, x fastest.
class Lattice {
 public:
  Lattice(const Field& field, const model::Grid& grid, int k0, const Block& b) {
    for (int k = 0; k <= b.z.end - b.z.begin; ++k) {
      for (int j = 0; j <= b.y.end - b.y.begin; ++j) {
        for (int i = 0; i <= b.x.end - b.x.begin; ++i) {
          values_[index(i, j, k)] = field.value(
              {grid.x_mm(b.x.begin + i - 0.5), grid.y_mm(b.y.begin + j - 0.5), grid.z_mm(k0 + b.z.begin + k - 0.5)});
        }
      }
    }
  }

  // Of the voxel that is the i, j, k-th of the block.
  [[nodiscard]] Corners corners(int i, int j, int k) const {
    Corners corners{};
    for (int c = 0; c < 8; ++c) {
      corners[c] = values_[index(i + (c & 1), j + ((c >> 1) & 1), k + (c >> 2))];
    }
    return corners;
  }

 private:
  static constexpr std::size_t side = block + 1;
  static std::size_t index(int i, int j, int k) {
    return (static_cast<std::size_t>(k) * side + static_cast<std::size_t>(j)) * side + static_cast<std::size_t>(i);
  }
  std::array<double, side * side * side> values_{};
};

void cover_block(const Field& field, const model::Grid& grid, int k0, const Block& b, float* out) {
  const auto at = [&](int i, int j, int k) {
    return out + (static_cast<std::ptrdiff_t>(k) * grid.ny + j) * grid.nx + i;
  };
  if (const int side = side_of(field, grid, k0, b); side != 0) {
    for (int k = b.z.begin; k < b.z.end; ++k) {
      for (int j = b.y.begin; j < b.y.end; ++j) {
        std::fill(at(b.x.begin, j, k), at(b.x.end, j, k), side < 0 ? 1.0F : 0.0F);
      }
    }
    return;
  }
  const Lattice lattice(field, grid, k0, b);
  for (int k = b.z.begin; k < b.z.end; ++k) {
    for (int j = b.y.begin; j < b.y.end; ++j) {
      for (int i = b.x.begin; i < b.x.end; ++i) {
        const Point centre{grid.x_mm(i), grid.y_mm(j), grid.z_mm(k0 + k)};
        const Corners corners = lattice.corners(i - b.x.begin, j - b.y.begin, k - b.z.begin);
        *at(i, j, k) = static_cast<float>(cell_fraction(field, centre, grid.voxel_mm, corners, 0));
      }
    }
  }
}

}  // namespace

void cover(const Field& field, const model::Grid& grid, int k0, int count, float* out) {
  const int blocks_y = (grid.ny + block - 1) / block;
  const int blocks_z = (count + block - 1) / block;
  parallel_for(blocks_y * blocks_z, [&](int item) {
    const int j = item % blocks_y * block;
    const int k = item / blocks_y * block;
    for (int i = 0; i < grid.nx; i += block) {
      cover_block(
          field, grid, k0,
          {{i, std::min(i + block, grid.nx)}, {j, std::min(j + block, grid.ny)}, {k, std::min(k + block, count)}}, out);
    }
  });
}

}  // namespace vam::solid
