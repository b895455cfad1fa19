#include "solid/shapes/field.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

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

}  // namespace vam::solid
