#include "solid/field.hpp"

#include <numbers>
#include <vector>

#include "base/parallel.hpp"

namespace vam::solid {

double Field::support_mm(const Point& d) const {
  const Point centre = box.centre();
  const Point half = 0.5 * box.size();
  const double by_box = dot(d, centre) + std::abs(d[0]) * half[0] + std::abs(d[1]) * half[1] + std::abs(d[2]) * half[2];
  const double by_cylinder = std::hypot(d[0], d[1]) * radius_mm + d[2] * centre[2] + std::abs(d[2]) * half[2];
  const double by_ball = dot(d, centre) + ball_mm;
  return std::min({by_box, by_cylinder, by_ball});
}

Field transformed(const Field& field, const Affine& map) {
  const Affine back = inverse(map);
  // Support of the image in direction d: support of the original along the transposed map of d.
  const auto support = [&](const Point& d) {
    const auto& m = map.linear;
    const Point pulled = d[0] * m[0] + d[1] * m[1] + d[2] * m[2];
    const double norm = length(pulled);
    return norm * field.support_mm((1 / norm) * pulled) + dot(d, map.shift);
  };
  // The Frobenius norm bounds the spectral one; for a rotation with one scale it is sqrt(3) too large, so use the
  // largest row of back * back^T (Gershgorin), which is exact there.
  double lipschitz_squared = 0;
  for (const Point& row : back.linear) {
    double sum = 0;
    for (const Point& other : back.linear) sum += std::abs(dot(row, other));
    lipschitz_squared = std::max(lipschitz_squared, sum);
  }
  Field result;
  result.lipschitz = field.lipschitz * std::sqrt(lipschitz_squared);
  result.curvature_per_mm = field.curvature_per_mm * std::sqrt(lipschitz_squared);
  for (std::size_t a = 0; a < 3; ++a) {
    Point d{};
    d[a] = 1;
    result.box.high[a] = support(d);
    d[a] = -1;
    result.box.low[a] = -support(d);
  }
  constexpr int directions = 720;
  for (int i = 0; i < directions; ++i) {
    const double angle = 2 * std::numbers::pi * i / directions;
    result.radius_mm = std::max(result.radius_mm, support({std::cos(angle), std::sin(angle), 0}));
  }
  // A corner between two sampled directions sticks out by less than 1 - cos(pi / 720).
  result.radius_mm /= std::cos(std::numbers::pi / directions);
  double stretch = 0;
  for (const Point& row : map.linear) stretch = std::max(stretch, length(row));
  result.ball_mm = std::min(0.5 * result.box.diagonal(),
                            stretch * field.ball_mm + length(map(field.box.centre()) - result.box.centre()));
  result.value = [inner = field.value, back](const Point& p) { return inner(back(p)); };
  return result;
}

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

double cell_fraction(const Field& field, const Point& centre, double edge_mm, const Corners& corners, int depth) {
  const double middle = field.value(centre);
  if (std::abs(middle) > slack * field.lipschitz * half_diagonal * edge_mm) return middle < 0 ? 1 : 0;
  double mean = 0;
  Point slope{};  // change of the field across the cell along each axis
  for (unsigned c = 0; c < 8; ++c) {
    mean += corners[c] / 8;
    slope = slope + (corners[c] / 2) * corner_sign(c);
  }
  Corners residual{};
  for (unsigned c = 0; c < 8; ++c) residual[c] = corners[c] - mean - dot(slope, corner_sign(c));
  double even = std::abs(middle - mean);
  double odd = 0;
  for (unsigned c = 0; c < 4; ++c) {
    even = std::max(even, 0.5 * std::abs(residual[c] + residual[7 - c]));
    odd = std::max(odd, 0.5 * std::abs(residual[c] - residual[7 - c]));
  }
  const double steepness = length(slope);
  const double even_limit = std::clamp(0.3 * field.curvature_per_mm * edge_mm, even_least, even_most);
  const bool smooth = even <= even_limit * steepness && odd <= odd_limit * steepness;
  if (!smooth && depth == deepest) {
    // What an edge makes of a plane fitted to it must not cut corners that are all on one side.
    const auto [low, high] = std::minmax_element(corners.begin(), corners.end());
    if (*high <= 0 && middle <= 0) return 1;
    if (*low >= 0 && middle >= 0) return 0;
  }
  if (smooth || depth == deepest) {
    if (steepness == 0) return middle < 0 ? 1 : 0;
    // The mean over the cell of a field that is quadratic: two thirds centre, one third corners.
    return cube_fraction((2 * middle + mean) / 3, slope);
  }
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

struct Span {
  int begin;
  int end;
};

// Voxels of one block [x) x [y) x [z), z relative to k0.
void cover_block(const Field& field, const model::Grid& grid, int k0, Span x, Span y, Span z, float* out) {
  const double h = grid.voxel_mm;
  const Point centre{grid.x_mm(0.5 * (x.begin + x.end - 1)), grid.y_mm(0.5 * (y.begin + y.end - 1)),
                     grid.z_mm(k0 + 0.5 * (z.begin + z.end - 1))};
  const Point half{0.5 * h * (x.end - x.begin), 0.5 * h * (y.end - y.begin), 0.5 * h * (z.end - z.begin)};
  const auto at = [&](int i, int j, int k) {
    return out + (static_cast<std::ptrdiff_t>(k) * grid.ny + j) * grid.nx + i;
  };
  const double whole = field.value(centre);
  if (std::abs(whole) > slack * field.lipschitz * length(half)) {
    for (int k = z.begin; k < z.end; ++k) {
      for (int j = y.begin; j < y.end; ++j) std::fill(at(x.begin, j, k), at(x.end, j, k), whole < 0 ? 1.0F : 0.0F);
    }
    return;
  }
  constexpr int side = block + 1;
  std::array<double, static_cast<std::size_t>(side) * side * side> lattice{};  // field at voxel corners
  const auto node = [&](int i, int j, int k) -> double& {
    return lattice[static_cast<std::size_t>((k * side + j) * side + i)];
  };
  for (int k = 0; k <= z.end - z.begin; ++k) {
    for (int j = 0; j <= y.end - y.begin; ++j) {
      for (int i = 0; i <= x.end - x.begin; ++i) {
        node(i, j, k) = field.value(
            {grid.x_mm(x.begin + i - 0.5), grid.y_mm(y.begin + j - 0.5), grid.z_mm(k0 + z.begin + k - 0.5)});
      }
    }
  }
  for (int k = z.begin; k < z.end; ++k) {
    for (int j = y.begin; j < y.end; ++j) {
      for (int i = x.begin; i < x.end; ++i) {
        Corners corners{};
        for (int c = 0; c < 8; ++c) {
          corners[static_cast<std::size_t>(c)] =
              node(i - x.begin + (c & 1), j - y.begin + ((c >> 1) & 1), k - z.begin + (c >> 2));
        }
        const double f = cell_fraction(field, {grid.x_mm(i), grid.y_mm(j), grid.z_mm(k0 + k)}, h, corners, 0);
        *at(i, j, k) = static_cast<float>(f);
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
      cover_block(field, grid, k0, {i, std::min(i + block, grid.nx)}, {j, std::min(j + block, grid.ny)},
                  {k, std::min(k + block, count)}, out);
    }
  });
}

}  // namespace vam::solid
