// SPDX-License-Identifier: GPL-3.0-or-later
#include "oracle/lens_dose.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <utility>

namespace vam::oracle {

namespace {

using std::numbers::pi;

/// Rays in the resin and before it alike.
using Ray = ResinRay;

/// Light in air: where it passes the plane y = 0, and its tangents; what was lost on its way.
struct AirRay {
  double x = 0, z = 0, slope_x = 0, slope_z = 0;
  double transmitted = 1, path = 0;  // path in the resin
};

double horizontal(const LensPoint& a, const LensPoint& b) { return a.x * b.x + a.y * b.y; }
LensPoint ahead(const LensPoint& at, const LensPoint& along, double length) {
  return {at.x + length * along.x, at.y + length * along.y, at.z + length * along.z};
}

LensPoint unit(double x, double y, double z) {
  const double length = std::sqrt(x * x + y * y + z * z);
  return {x / length, y / length, z / length};
}

/// Snell's law in vector form at a surface whose horizontal unit normal is (x, y), from index `before` to `after`.
void refract(Ray& ray, double x, double y, double before, double after) {
  double into = x * ray.along.x + y * ray.along.y;
  if (into < 0) into = -into, x = -x, y = -y;
  const double ratio = before / after;
  const double square = 1 - ratio * ratio * (1 - into * into);
  if (square <= 0) {
    ray.transmitted = 0;
    return;
  }
  const double out = std::sqrt(square);
  const double s = (before * into - after * out) / (before * into + after * out);
  const double p = (after * into - before * out) / (after * into + before * out);
  ray.transmitted *= 1 - (s * s + p * p) / 2;
  const double turn = out - ratio * into;
  ray.along = {ratio * ray.along.x + turn * x, ratio * ray.along.y + turn * y, ratio * ray.along.z};
}

/// On to the cylinder, where the ray enters (side -1) or leaves it (side 1), and through its surface.
void cross(Ray& ray, double radius, int side, double before, double after) {
  const double a = horizontal(ray.along, ray.along), b = horizontal(ray.at, ray.along);
  const double square = b * b - a * (horizontal(ray.at, ray.at) - radius * radius);
  if (square <= 0) ray.transmitted = 0;
  if (ray.transmitted == 0) return;
  ray.at = ahead(ray.at, ray.along, (-b + side * std::sqrt(square)) / a);
  refract(ray, ray.at.x / radius, ray.at.y / radius, before, after);
}

void pass_window(Ray& ray, const LensBench& bench, double before, double after) {
  if (bench.window == 0 || ray.transmitted == 0) return;
  ray.at = ahead(ray.at, ray.along, (-bench.window - ray.at.y) / ray.along.y);
  refract(ray, 0, 1, before, after);
}

double inner(const LensBench& bench) { return bench.radius - bench.wall; }
double wall_index(const LensBench& bench) { return bench.wall > 0 ? bench.glass : bench.resin; }

/// Light in the image plane, across or along z, by what it is in y = 0: the tangent to the chief ray, and the pixel's
/// place.
struct Imaged {
  double pupil = 0, place = 0;
};

Imaged imaged(double at, double slope, double lens, double focus) {
  const double image = at + slope * focus;
  if (lens == 0) return {slope, image};
  return {(slope * lens - at) / (lens + focus), image * lens / (lens + focus)};
}

int pixel_of(double place, double pixel) { return static_cast<int>(std::floor(place / pixel)); }

/// The part's (x, y) at a stage angle in the laboratory; the other way with -angle.
LensPoint turned(const LensPoint& at, double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  return {at.x * c + at.y * s, at.y * c - at.x * s, at.z};
}

/// Backwards: the light that passes a point of the resin with the tangents (slope_x, slope_z).
AirRay trace_out(const LensBench& bench, const LensPoint& at, double slope_x, double slope_z) {
  const LensPoint light = unit(slope_x, 1, slope_z);
  Ray ray{at, {-light.x, -light.y, -light.z}};
  cross(ray, inner(bench), 1, bench.resin, bench.wall > 0 ? bench.glass : bench.bath);
  const double path = (ray.at.y - at.y) / -light.y;
  if (bench.wall > 0) cross(ray, bench.radius, 1, bench.glass, bench.bath);
  pass_window(ray, bench, bench.bath, bench.air);
  const LensPoint axis = ahead(ray.at, ray.along, -ray.at.y / ray.along.y);
  return {axis.x, axis.z, ray.along.x / ray.along.y, ray.along.z / ray.along.y, ray.transmitted, path};
}

/// The light through a point from one point of the pupil, found from that at the angle before.
class Sight {
 public:
  Sight(const LensBench& bench, const PupilPoint& point) : bench_(bench), point_(point) {}

  /// Power per area across the ray that a pixel of power 1 per area leaves there; its place becomes (x, z).
  double look(const LensPoint& at, double& x, double& z) {
    for (int step = 0; step < 50; step++) {
      const State here = state(at, p_, q_);
      const State right = state(at, p_ + small_, q_), up = state(at, p_, q_ + small_);
      const double px = (right.x.pupil - here.x.pupil) / small_, pz = (right.z.pupil - here.z.pupil) / small_;
      const double qx = (up.x.pupil - here.x.pupil) / small_, qz = (up.z.pupil - here.z.pupil) / small_;
      const double det = px * qz - qx * pz;
      const double miss_x = here.x.pupil - point_.x, miss_z = here.z.pupil - point_.z;
      if (std::abs(miss_x) + std::abs(miss_z) < 1e-9) {
        x = here.x.place, z = here.z.place;
        return here.density / std::abs(det);
      }
      p_ -= (qz * miss_x - qx * miss_z) / det;
      q_ -= (px * miss_z - pz * miss_x) / det;
    }
    throw std::runtime_error("lens_dose: no ray from the pupil to the point");
  }

 private:
  struct State {
    Imaged x, z;
    double density = 0;
  };

  /// Area times solid angle times the square of the index is the same in the resin and in the image plane.
  State state(const LensPoint& at, double p, double q) const {
    const AirRay air = trace_out(bench_, at, p, q);
    const auto shrunk = [&](double lens) { return lens > 0 ? lens / (lens + bench_.focus) : 1; };
    const double scale = shrunk(bench_.column_throw) * shrunk(bench_.row_throw);
    const double square = 1 + air.slope_x * air.slope_x + air.slope_z * air.slope_z;
    const double density = scale * std::pow(square * bench_.resin / bench_.air, 2) / std::pow(1 + p * p + q * q, 1.5);
    return {imaged(air.x, air.slope_x, bench_.column_throw, bench_.focus),
            imaged(air.z, air.slope_z, bench_.row_throw, bench_.focus),
            density * air.transmitted * std::exp(-bench_.absorption * air.path)};
  }

  const LensBench& bench_;
  PupilPoint point_;
  double p_ = 0, q_ = 0;
  static constexpr double small_ = 1e-6;
};

/// What lies of a ray in a cube around `at`: from, to.
std::pair<double, double> within(const Ray& ray, const LensPoint& at, double edge) {
  double from = 0, to = 1e300;
  const auto clip = [&](double place, double along) {
    const double a = (-edge / 2 - place) / along, b = (edge / 2 - place) / along;
    from = std::max(from, std::min(a, b)), to = std::min(to, std::max(a, b));
  };
  clip(ray.at.x - at.x, ray.along.x), clip(ray.at.y - at.y, ray.along.y), clip(ray.at.z - at.z, ray.along.z);
  return {from, std::max(from, to)};
}

}  // namespace

std::vector<PupilPoint> round_pupil(double half_angle, int rings) {
  std::vector<PupilPoint> points;
  for (int ring = 0; ring < rings; ring++) {
    const double radius =
        std::tan(half_angle) * std::sqrt(ring * ring + ring + 0.5) / rings;  // mean square of its annulus
    const int count = 4 * (2 * ring + 1);
    for (int i = 0; i < count; i++) {
      const double angle = 2 * pi * (i + 0.5) / count;
      points.push_back({radius * std::cos(angle), radius * std::sin(angle), 0.25 / (rings * rings)});
    }
  }
  return points;
}

std::vector<HoldAngle> held(double width, int count) {
  std::vector<HoldAngle> angles;
  for (int i = 0; i < count; i++) angles.push_back({width * ((i + 0.5) / count - 0.5), 1.0 / count});
  return angles;
}

std::vector<HoldAngle> chords(double half_angle, int count) {
  std::vector<HoldAngle> angles;  // Gauss-Chebyshev of the second kind
  for (int i = 1; i <= count; i++) {
    const double at = pi * i / (count + 1);
    angles.push_back({half_angle * std::cos(at), 2.0 / (count + 1) * std::pow(std::sin(at), 2)});
  }
  return angles;
}

ResinRay trace_in(const LensBench& bench, double x, double z, const PupilPoint& point) {
  const double slope_x = point.x + (bench.column_throw > 0 ? x / bench.column_throw : 0);
  const double slope_z = point.z + (bench.row_throw > 0 ? z / bench.row_throw : 0);
  const double first = bench.window > 0 ? bench.window : bench.radius;
  Ray ray{{x - bench.focus * point.x - first * slope_x, -first, z - bench.focus * point.z - first * slope_z},
          unit(slope_x, 1, slope_z)};
  pass_window(ray, bench, bench.air, bench.bath);
  cross(ray, bench.radius, -1, bench.bath, wall_index(bench));
  if (bench.wall > 0) cross(ray, inner(bench), -1, bench.glass, bench.resin);
  return ray;
}

double lens_dose(const LensBench& bench, const Frames& frames, const LensPoint& at) {
  const double step = 2 * pi / bench.frames;
  double dose = 0;
  for (const PupilPoint& point : bench.pupil) {
    Sight sight(bench, point);
    for (int frame = 0; frame < bench.frames; frame++) {
      for (const HoldAngle& hold : bench.hold) {
        double x = 0, z = 0;
        const double density = sight.look(turned(at, frame * step + hold.angle), x, z);
        dose += step * point.weight * hold.weight * density *
                frames(frame, pixel_of(z, bench.pixel), pixel_of(x, bench.pixel));
      }
    }
  }
  return dose;
}

double deposited_lens_dose(const LensBench& bench, const Frames& frames, const LensPoint& at, double edge, int columns,
                           int rows, int rays) {
  const double step = 2 * pi / bench.frames, fine = bench.pixel / rays;
  double dose = 0, x_shift = 0, z_shift = 0;  // another place of the grid of rays each time, evenly spread
  for (int frame = 0; frame < bench.frames; frame++) {
    for (const PupilPoint& point : bench.pupil) {
      x_shift = std::fmod(x_shift + 0.7548776662, 1), z_shift = std::fmod(z_shift + 0.5698402910, 1);
      for (int row = -rows * rays; row < rows * rays; row++) {
        for (int column = -columns * rays; column < columns * rays; column++) {
          const double x = (column + x_shift) * fine, z = (row + z_shift) * fine;
          const double power = fine * fine * frames(frame, pixel_of(z, bench.pixel), pixel_of(x, bench.pixel));
          const Ray ray = trace_in(bench, x, z, point);
          for (const HoldAngle& hold : bench.hold) {
            const double angle = -(frame * step + hold.angle);
            const auto [from, to] = within({turned(ray.at, angle), turned(ray.along, angle)}, at, edge);
            dose += step * power * point.weight * hold.weight * ray.transmitted * (to - from) *
                    std::exp(-bench.absorption * (from + to) / 2);
          }
        }
      }
    }
  }
  return dose / std::pow(edge, 3);
}

}  // namespace vam::oracle
