// SPDX-License-Identifier: GPL-3.0-or-later
#include "solid/shapes/private/gyroid_kernel.hpp"

namespace vam::solid::VAM_SIMD {

namespace {

#define VAM_INLINE inline __attribute__((always_inline))

struct Vec {
  double x, y, z;
};
VAM_INLINE double dot(const Vec& a, const Vec& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
VAM_INLINE Vec operator*(double factor, const Vec& a) { return {factor * a.x, factor * a.y, factor * a.z}; }

// Adding and subtracting this rounds to the nearest whole number.
constexpr double rounder = 6755399441055744.0;  // 1.5 * 2^52
VAM_INLINE double rounded(double value) { return (value + rounder) - rounder; }

struct Turned {
  double sine, cosine;
};

// To 1e-13: quarter turns are taken off, and power series do the rest.
VAM_INLINE Turned turned(double angle) {
  constexpr double quarter = 1.57079632679489661923;
  const double quarters = rounded(angle * (1 / quarter));
  const double r = angle - quarters * quarter;
  const double q = r * r;
  const double s =
      r *
      (1 - q * (1.0 / 6) *
               (1 - q * (1.0 / 20) *
                        (1 - q * (1.0 / 42) * (1 - q * (1.0 / 72) * (1 - q * (1.0 / 110) * (1 - q * (1.0 / 156)))))));
  const double c =
      1 - q * (1.0 / 2) *
              (1 - q * (1.0 / 12) *
                       (1 - q * (1.0 / 30) *
                                (1 - q * (1.0 / 56) *
                                         (1 - q * (1.0 / 90) * (1 - q * (1.0 / 132) * (1 - q * (1.0 / 182)))))));
  const double m = quarters - 4 * rounded(0.25 * quarters);  // -2 ... 2
  const bool odd = m * m == 1;
  const double sine = odd ? c : s;
  const double cosine = odd ? s : c;
  return {m == -1 || m * m == 4 ? -sine : sine, m == 1 || m * m == 4 ? -cosine : cosine};
}

struct Level {
  Vec sine, cosine;
};

VAM_INLINE double value(const Level& at) {
  return at.sine.x * at.cosine.y + at.sine.y * at.cosine.z + at.sine.z * at.cosine.x;
}

VAM_INLINE Vec gradient(const Level& at) {  // per radian
  return {at.cosine.x * at.cosine.y - at.sine.z * at.sine.x, at.cosine.y * at.cosine.z - at.sine.x * at.sine.y,
          at.cosine.z * at.cosine.x - at.sine.y * at.sine.z};
}

// By the addition theorem with power series: to 1e-6 for |d| < 1.
VAM_INLINE void move(double& sine, double& cosine, double d) {
  const double q = d * d;
  const double s = d * (1 - q * (1.0 / 6) * (1 - q * (1.0 / 20) * (1 - q * (1.0 / 42))));
  const double c = 1 - q * (1.0 / 2) * (1 - q * (1.0 / 12) * (1 - q * (1.0 / 30) * (1 - q * (1.0 / 56))));
  const double moved = sine * c + cosine * s;
  cosine = cosine * c - sine * s;
  sine = moved;
}

VAM_INLINE Level moved(Level at, const Vec& d) {
  move(at.sine.x, at.cosine.x, d.x);
  move(at.sine.y, at.cosine.y, d.y);
  move(at.sine.z, at.cosine.z, d.z);
  return at;
}

}  // namespace

void gyroid_distances(const double* x, const double* y, const double* z, int count, double near, double* distances) {
#pragma GCC ivdep
  for (int i = 0; i < count; ++i) {
    const Turned tx = turned(x[i]), ty = turned(y[i]), tz = turned(z[i]);
    const Level here{{tx.sine, ty.sine, tz.sine}, {tx.cosine, ty.cosine, tz.cosine}};
    const double level = value(here);
    Vec normal = gradient(here);
    Vec step = (-level / dot(normal, normal)) * normal;  // to the foot point
#pragma GCC unroll 3
    for (int newton = 0; newton < 3; ++newton) {
      const Level there = moved(here, step);
      normal = gradient(there);
      // The nearest point of the plane on which the linearised F vanishes.
      step = ((dot(step, normal) - value(there)) / dot(normal, normal)) * normal;
    }
    const double bound = __builtin_fabs(level) * (1 / 1.73205080756887729353);
    const double length = __builtin_sqrt(dot(step, step));
    distances[i] = bound > near ? bound : length;
  }
}

}  // namespace vam::solid::VAM_SIMD
