// SPDX-License-Identifier: GPL-3.0-or-later
#include "oracle/convex.hpp"

#include <algorithm>
#include <cmath>

namespace vam::oracle {

namespace {

using Point = std::array<double, 3>;
using Face = std::vector<Point>;  // anticlockwise seen from outside, up to rounding

double dot(const Point& a, const Point& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Point minus(const Point& a, const Point& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
Point cross(const Point& a, const Point& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

Point middle(const Face& face) {
  Point sum{};
  for (const Point& p : face) {
    for (std::size_t a = 0; a < 3; ++a) sum[a] += p[a] / static_cast<double>(face.size());
  }
  return sum;
}

// Points around the cut, in order about the plane's normal.
Face cap(Face rim, const Point& normal) {
  if (rim.size() < 3) return {};
  const Point centre = middle(rim);
  const Point seed = std::abs(normal[0]) < 0.6 ? Point{1, 0, 0} : Point{0, 1, 0};
  const Point u = cross(normal, seed);
  const Point v = cross(normal, u);
  const double u_length = std::sqrt(dot(u, u));
  const double v_length = std::sqrt(dot(v, v));
  const auto angle = [&](const Point& p) {
    return std::atan2(dot(minus(p, centre), v) / v_length, dot(minus(p, centre), u) / u_length);
  };
  std::sort(rim.begin(), rim.end(), [&](const Point& p, const Point& q) { return angle(p) < angle(q); });
  return rim;
}

std::vector<Face> cut(const std::vector<Face>& body, const HalfSpace& half) {
  std::vector<Face> kept;
  Face rim;
  for (const Face& face : body) {
    Face inside;
    for (std::size_t i = 0; i < face.size(); ++i) {
      const Point& p = face[i];
      const Point& q = face[(i + 1) % face.size()];
      const double at_p = dot(half.normal, p) - half.offset;
      const double at_q = dot(half.normal, q) - half.offset;
      if (at_p <= 0) inside.push_back(p);
      if ((at_p <= 0) != (at_q <= 0)) {
        const double t = at_p / (at_p - at_q);
        const Point on{p[0] + t * (q[0] - p[0]), p[1] + t * (q[1] - p[1]), p[2] + t * (q[2] - p[2])};
        inside.push_back(on);
        rim.push_back(on);
      }
    }
    if (inside.size() >= 3) kept.push_back(inside);
  }
  const Face lid = cap(rim, half.normal);
  if (!lid.empty()) kept.push_back(lid);
  return kept;
}

}  // namespace

double shared_volume(const Point& centre, double edge, const std::vector<HalfSpace>& body) {
  const auto corner = [&](int c) {
    return Point{centre[0] + edge * ((c & 1) - 0.5), centre[1] + edge * ((c >> 1 & 1) - 0.5),
                 centre[2] + edge * ((c >> 2) - 0.5)};
  };
  std::vector<Face> faces;
  for (const std::array<int, 4>& f :
       {std::array<int, 4>{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}}) {
    faces.push_back({corner(f[0]), corner(f[1]), corner(f[2]), corner(f[3])});
  }
  for (const HalfSpace& half : body) faces = cut(faces, half);
  if (faces.size() < 4) return 0;
  // A convex body is the union of the pyramids from an inner point to its faces; orientation does not matter.
  Point inner{};
  for (const Face& face : faces) {
    const Point m = middle(face);
    for (std::size_t a = 0; a < 3; ++a) inner[a] += m[a] / static_cast<double>(faces.size());
  }
  double volume = 0;
  for (const Face& face : faces) {
    const Point m = middle(face);
    for (std::size_t i = 0; i < face.size(); ++i) {
      const Point a = minus(face[i], inner);
      const Point b = minus(face[(i + 1) % face.size()], inner);
      volume += std::abs(dot(minus(m, inner), cross(a, b))) / 6;
    }
  }
  return volume;
}

}  // namespace vam::oracle
