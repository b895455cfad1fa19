// SPDX-License-Identifier: GPL-3.0-or-later
#include "oracle/meshes.hpp"

#include <cmath>
#include <numbers>
#include <random>

namespace vam::oracle {

namespace {

using Point = std::array<double, 3>;
using std::numbers::pi;

Point on_sphere(double radius, double polar, double azimuth) {
  return {radius * std::sin(polar) * std::cos(azimuth), radius * std::sin(polar) * std::sin(azimuth),
          radius * std::cos(polar)};
}

template <typename Keep>
model::TriangleSoup filtered(const model::TriangleSoup& mesh, const Keep& keep) {
  model::TriangleSoup result{mesh.points, {}};
  for (const auto& t : mesh.triangles) {
    if (keep(t)) result.triangles.push_back(t);
  }
  return result;
}

}  // namespace

model::TriangleSoup lumpy_sphere(double radius, int bands, double amount) {
  model::TriangleSoup mesh;
  const int around = 2 * bands;
  const auto radius_at = [&](double polar, double azimuth) {
    return radius * (1 + amount * std::sin(3 * polar + 1) * std::sin(2 * azimuth + 0.3) * std::sin(polar) +
                     0.5 * amount * std::cos(5 * polar));
  };
  mesh.points.push_back(on_sphere(radius_at(0, 0), 0, 0));
  for (int b = 1; b < bands; ++b) {
    for (int a = 0; a < around; ++a) {
      const double polar = pi * b / bands;
      const double azimuth = 2 * pi * a / around;
      mesh.points.push_back(on_sphere(radius_at(polar, azimuth), polar, azimuth));
    }
  }
  mesh.points.push_back(on_sphere(radius_at(pi, 0), pi, 0));
  const auto at = [&](int b, int a) { return 1 + (b - 1) * around + a % around; };
  const int south = static_cast<int>(mesh.points.size()) - 1;
  for (int a = 0; a < around; ++a) {
    mesh.triangles.push_back({0, at(1, a), at(1, a + 1)});
    for (int b = 1; b + 1 < bands; ++b) {
      mesh.triangles.push_back({at(b, a), at(b + 1, a), at(b + 1, a + 1)});
      mesh.triangles.push_back({at(b, a), at(b + 1, a + 1), at(b, a + 1)});
    }
    mesh.triangles.push_back({south, at(bands - 1, a + 1), at(bands - 1, a)});
  }
  return mesh;
}

model::TriangleSoup sphere(double radius, int bands) { return lumpy_sphere(radius, bands, 0); }

model::TriangleSoup box(const Point& low, const Point& high) {
  model::TriangleSoup mesh;
  for (int c = 0; c < 8; ++c) {
    mesh.points.push_back(
        {(c & 1) != 0 ? high[0] : low[0], (c & 2) != 0 ? high[1] : low[1], (c & 4) != 0 ? high[2] : low[2]});
  }
  mesh.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                    {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  return mesh;
}

model::TriangleSoup join(const model::TriangleSoup& a, const model::TriangleSoup& b, const Point& shift) {
  model::TriangleSoup result = a;
  const int offset = static_cast<int>(a.points.size());
  for (const Point& p : b.points) result.points.push_back({p[0] + shift[0], p[1] + shift[1], p[2] + shift[2]});
  for (const auto& t : b.triangles) result.triangles.push_back({t[0] + offset, t[1] + offset, t[2] + offset});
  return result;
}

model::TriangleSoup unwelded(const model::TriangleSoup& mesh) { return cracked(mesh, 0, 1); }

model::TriangleSoup cracked(const model::TriangleSoup& mesh, double amount, std::uint32_t seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> move(-amount, amount);
  model::TriangleSoup result;
  for (const auto& t : mesh.triangles) {
    const int first = static_cast<int>(result.points.size());
    for (const int corner : t) {
      Point p = mesh.points[corner];
      if (amount > 0) {
        for (double& c : p) c += move(random);
      }
      result.points.push_back(p);
    }
    result.triangles.push_back({first, first + 1, first + 2});
  }
  return result;
}

model::TriangleSoup without(const model::TriangleSoup& mesh, double share, std::uint32_t seed) {
  std::mt19937 random(seed);
  std::bernoulli_distribution chosen(share);
  return filtered(mesh, [&](const auto&) { return !chosen(random); });
}

model::TriangleSoup flipped(const model::TriangleSoup& mesh, double share, std::uint32_t seed) {
  std::mt19937 random(seed);
  std::bernoulli_distribution chosen(share);
  model::TriangleSoup result = mesh;
  for (auto& t : result.triangles) {
    if (share >= 1 || chosen(random)) std::swap(t[1], t[2]);
  }
  return result;
}

model::TriangleSoup repeated(const model::TriangleSoup& mesh, double share, std::uint32_t seed) {
  std::mt19937 random(seed);
  std::bernoulli_distribution chosen(share);
  model::TriangleSoup result = mesh;
  for (const auto& t : mesh.triangles) {
    if (share >= 1 || chosen(random)) result.triangles.push_back({t[1], t[2], t[0]});
  }
  return result;
}

model::TriangleSoup punched(const model::TriangleSoup& mesh, const Point& centre, double radius) {
  return filtered(mesh, [&](const auto& t) {
    double square = 0;
    for (std::size_t a = 0; a < 3; ++a) {
      double mean = 0;
      for (const int corner : t) mean += mesh.points[corner][a] / 3;
      square += (mean - centre[a]) * (mean - centre[a]);
    }
    return square > radius * radius;
  });
}

double signed_volume(const model::TriangleSoup& mesh) {
  double volume = 0;
  for (const auto& t : mesh.triangles) {
    const Point& a = mesh.points[t[0]];
    const Point& b = mesh.points[t[1]];
    const Point& c = mesh.points[t[2]];
    volume +=
        a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) + a[2] * (b[0] * c[1] - b[1] * c[0]);
  }
  return volume / 6;
}

}  // namespace vam::oracle
