// SPDX-License-Identifier: GPL-3.0-or-later
#include "metrology/compare/datum.hpp"

#include <cmath>

#include "base/error.hpp"

namespace vam::metrology {

namespace {

using Rows = std::array<Vector3, 3>;

/// Right-handed axes: the primary normal, the secondary's part across it, their product.
Rows frame_of(const Vector3& primary, const Vector3& secondary) {
  constexpr double least = 0.2;  // sine of the angle between the two
  const Vector3 rest = secondary - dot(secondary, primary) * primary;
  if (length(rest) < least) {
    throw Error{Fault::data, "--datum: the first two faces are nearly parallel; choose faces across each other"};
  }
  const Vector3 second = (1 / length(rest)) * rest;
  return {primary, second, cross(primary, second)};
}

/// x with rows * x = right (Cramer).
Vector3 solved(const Rows& rows, const Vector3& right) {
  const double volume = dot(rows[0], cross(rows[1], rows[2]));
  constexpr double least = 0.1;
  if (std::abs(volume) < least) {
    throw Error{Fault::data, "--datum: the three faces do not fix the part; choose faces across each other"};
  }
  return (1 / volume) *
         (right[0] * cross(rows[1], rows[2]) + right[1] * cross(rows[2], rows[0]) + right[2] * cross(rows[0], rows[1]));
}

}  // namespace

solid::Similarity datum_motion(const std::array<DatumFace, 3>& faces) {
  const Rows from = frame_of(faces[0].print.normal, faces[1].print.normal);
  const Rows to = frame_of(faces[0].design.normal, faces[1].design.normal);
  solid::Similarity motion;
  for (std::size_t r = 0; r < 3; ++r) {
    for (std::size_t c = 0; c < 3; ++c) {
      motion.rotation[r][c] = to[0][r] * from[0][c] + to[1][r] * from[1][c] + to[2][r] * from[2][c];
    }
  }
  Rows normals{};
  Vector3 gaps{};
  for (std::size_t f = 0; f < 3; ++f) {
    normals[f] = faces[f].design.normal;
    gaps[f] = dot(normals[f], faces[f].design.point - motion(faces[f].print.point));
  }
  motion.shift_mm = solved(normals, gaps);
  return motion;
}

solid::Similarity after(const solid::Similarity& a, const solid::Similarity& b) {
  solid::Similarity both;
  both.scale = a.scale * b.scale;
  for (std::size_t r = 0; r < 3; ++r) {
    for (std::size_t c = 0; c < 3; ++c) {
      both.rotation[r][c] = a.rotation[r][0] * b.rotation[0][c] + a.rotation[r][1] * b.rotation[1][c] +
                            a.rotation[r][2] * b.rotation[2][c];
    }
  }
  both.shift_mm = a(b.shift_mm);
  return both;
}

}  // namespace vam::metrology
