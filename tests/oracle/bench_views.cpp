// SPDX-License-Identifier: GPL-3.0-or-later
#include "oracle/bench_views.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <thread>

namespace vam::oracle {

namespace {

struct Beam {
  bool there = false;
  Place point{};      // where it enters the resin
  Place direction{};  // unit
  double passed = 1;  // transmittance
};

double dot(const Place& a, const Place& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Place along(const Place& p, double s, const Place& d) { return {p[0] + s * d[0], p[1] + s * d[1], p[2] + s * d[2]}; }

// Vector Snell with Fresnel's transmittance of unpolarised light; the unit normal is against the ray.
void refract(Beam& beam, const Place& normal, double n1, double n2) {
  const double r = n1 / n2;
  const double c1 = -dot(beam.direction, normal);
  const double rest = 1 - r * r * (1 - c1 * c1);
  if (rest < 0) {
    beam.there = false;
    return;
  }
  const double c2 = std::sqrt(rest);
  const double across = (n1 * c1 - n2 * c2) / (n1 * c1 + n2 * c2);
  const double level = (n2 * c1 - n1 * c2) / (n2 * c1 + n1 * c2);
  for (std::size_t i = 0; i < 3; ++i) beam.direction[i] = r * beam.direction[i] + (r * c1 - c2) * normal[i];
  beam.passed *= 1 - (across * across + level * level) / 2;
}

void enter(Beam& beam, double radius, double n1, double n2) {
  const Place& p = beam.point;
  const Place& d = beam.direction;
  const double a = d[0] * d[0] + d[1] * d[1];
  const double b = p[0] * d[0] + p[1] * d[1];
  const double square = b * b - a * (p[0] * p[0] + p[1] * p[1] - radius * radius);
  if (square < 0) {
    beam.there = false;
    return;
  }
  beam.point = along(p, (-b - std::sqrt(square)) / a, d);
  refract(beam, {beam.point[0] / radius, beam.point[1] / radius, 0}, n1, n2);
}

// As it comes to the vial, in the frame of the lab; one after the other, as their pixels and the rays in these.
Beam sight(const ViewBench& bench, std::size_t at) {
  const auto side = static_cast<std::size_t>(bench.rays);
  const auto columns = static_cast<std::size_t>(bench.columns);
  const auto place = [&](std::size_t n, std::size_t pixel) {
    return static_cast<double>(pixel) + (static_cast<double>(n % side) + 0.5) / bench.rays - 0.5;
  };
  const double x = (place(at, at / (side * side) % columns) - bench.axis_column) * bench.pixel_mm;
  const double z = (bench.axis_row - place(at / side, at / (side * side) / columns)) * bench.pixel_mm;
  const double back = bench.lens_mm > 0 ? bench.lens_mm : 100;
  const Place lens = bench.lens_mm > 0 ? Place{0, -back, 0} : Place{x, -back, z};
  Beam beam{true, lens, {x - lens[0], back, z - lens[2]}, 1};
  const double length = std::sqrt(dot(beam.direction, beam.direction));
  for (double& v : beam.direction) v /= length;
  if (bench.window_mm > 0) {
    beam.point = along(beam.point, (back - bench.window_mm) / beam.direction[1], beam.direction);
    refract(beam, {0, -1, 0}, 1, bench.bath_index);
  }
  return beam;
}

// In the frame of the vial, which stands at (dx, dy) of the lab.
Beam entered(const ViewBench& bench, Beam beam, double dx, double dy) {
  beam.point[0] -= dx;
  beam.point[1] -= dy;
  double outside = bench.bath_index;
  if (bench.wall_mm > 0) {
    enter(beam, bench.vial_mm, outside, bench.glass_index);
    outside = bench.glass_index;
  }
  if (beam.there) enter(beam, bench.vial_mm - bench.wall_mm, outside, bench.resin_index);
  return beam;
}

// Narrows [from, to] to the slab |p + s d| <= half.
void clip(double p, double d, double half, double& from, double& to) {
  if (d == 0) {
    if (std::abs(p) > half) to = from;
    return;
  }
  const double a = (-half - p) / d;
  const double b = (half - p) / d;
  from = std::max(from, std::min(a, b));
  to = std::min(to, std::max(a, b));
}

// Narrows it to a |p + s d|^2 <= r^2, a, b, c the coefficients of the quadratic.
void clip_round(double a, double b, double c, double& from, double& to) {
  const double square = b * b - a * c;
  if (square <= 0) {
    to = from;
    return;
  }
  const double root = std::sqrt(square);
  from = std::max(from, (-b - root) / a);
  to = std::min(to, (-b + root) / a);
}

// Light that the body scatters along the ray p + s d, s from its entry into the resin.
double scattered(const Body& body, const Place& point, const Place& d, double absorption) {
  const Place p{point[0] - body.centre[0], point[1] - body.centre[1], point[2] - body.centre[2]};
  double from = 0;
  double to = 1e9;
  const double r2 = body.half[0] * body.half[0];
  if (body.kind == Body::Kind::ball) {
    clip_round(1, dot(p, d), dot(p, p) - r2, from, to);
  } else if (body.kind == Body::Kind::cylinder) {
    clip_round(d[0] * d[0] + d[1] * d[1], p[0] * d[0] + p[1] * d[1], p[0] * p[0] + p[1] * p[1] - r2, from, to);
    clip(p[2], d[2], body.half[2], from, to);
  } else {
    for (std::size_t i = 0; i < 3; ++i) clip(p[i], d[i], body.half[i], from, to);
  }
  if (to <= from) return 0;
  if (absorption == 0) return body.density * (to - from);
  return body.density * (std::exp(-absorption * from) - std::exp(-absorption * to)) / absorption;
}

Place turned(const Place& v, double c, double s) { return {c * v[0] - s * v[1], s * v[0] + c * v[1], v[2]}; }
Place turned(const Place& v, double angle) { return turned(v, std::cos(angle), std::sin(angle)); }

std::vector<float> one_view(const ViewBench& bench, const std::vector<Body>& bodies, const std::vector<Bubble>& bubbles,
                            double share, bool wobbles, const std::vector<Beam>& sights) {
  // A point of the lab is that of the part turned back by the angle of the part.
  const double angle = 2 * std::numbers::pi * share + bench.azimuth_deg * std::numbers::pi / 180;
  const Place shift = turned({bench.run_out_mm[0], bench.run_out_mm[1], 0}, -angle);
  std::vector<Body> all = bodies;
  for (const Bubble& bubble : bubbles) {
    Body body = bubble.body;
    body.centre = turned(body.centre, 2 * std::numbers::pi * share * (1 - bubble.carried));
    body.centre[2] += bubble.rise_mm * share;
    all.push_back(body);
  }
  const auto rays = static_cast<std::size_t>(bench.rays) * static_cast<std::size_t>(bench.rays);
  const double c = std::cos(angle);
  const double s = std::sin(angle);
  std::vector<float> pixels;
  pixels.reserve(sights.size() / rays);
  for (std::size_t i = 0; i < sights.size(); i += rays) {
    double light = 0;
    for (std::size_t n = i; n < i + rays; ++n) {
      const Beam beam = wobbles ? entered(bench, sights[n], shift[0], shift[1]) : sights[n];
      if (!beam.there) continue;
      const Place p = turned(beam.point, c, s);
      const Place d = turned(beam.direction, c, s);
      for (const Body& body : all) light += beam.passed * scattered(body, p, d, bench.absorption_per_mm);
    }
    pixels.push_back(static_cast<float>(light / static_cast<double>(rays)));
  }
  return pixels;
}

double body_distance(const Body& body, const Place& point) {
  const Place p{point[0] - body.centre[0], point[1] - body.centre[1], point[2] - body.centre[2]};
  if (body.kind == Body::Kind::ball) return std::sqrt(dot(p, p)) - body.half[0];
  Place q{std::abs(p[0]) - body.half[0], std::abs(p[1]) - body.half[1], std::abs(p[2]) - body.half[2]};
  if (body.kind == Body::Kind::cylinder) q = {std::hypot(p[0], p[1]) - body.half[0], -1e9, q[2]};
  const double inside = std::min(0.0, std::max({q[0], q[1], q[2]}));
  return inside + std::sqrt(std::pow(std::max(q[0], 0.0), 2) + std::pow(std::max(q[1], 0.0), 2) +
                            std::pow(std::max(q[2], 0.0), 2));
}

float brightest(const std::vector<std::vector<float>>& views) {
  float most = 0;
  for (const auto& view : views) most = std::max(most, *std::max_element(view.begin(), view.end()));
  return most;
}

}  // namespace

std::vector<std::vector<float>> bench_views(const ViewBench& bench, const std::vector<Body>& bodies,
                                            const std::vector<Bubble>& bubbles, int count) {
  const auto pixels = static_cast<std::size_t>(bench.rows) * static_cast<std::size_t>(bench.columns);
  std::vector<Beam> sights(pixels * static_cast<std::size_t>(bench.rays) * static_cast<std::size_t>(bench.rays));
  const bool wobbles = bench.run_out_mm[0] != 0 || bench.run_out_mm[1] != 0;
  for (std::size_t n = 0; n < sights.size(); ++n) {
    sights[n] = wobbles ? sight(bench, n) : entered(bench, sight(bench, n), 0, 0);
  }
  std::vector<std::vector<float>> views(static_cast<std::size_t>(count));
  std::vector<std::thread> workers;
  const int threads = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  for (int t = 0; t < threads; ++t) {
    workers.emplace_back([&, t] {
      for (int i = t; i < count; i += threads)
        views[static_cast<std::size_t>(i)] =
            one_view(bench, bodies, bubbles, static_cast<double>(i) / count, wobbles, sights);
    });
  }
  for (auto& worker : workers) worker.join();
  return views;
}

void soil(const ViewBench& bench, const CleaningReport& dirt, std::vector<std::vector<float>>& views) {
  const auto peak = static_cast<double>(brightest(views));
  std::mt19937 random(dirt.draw);
  std::uniform_real_distribution<double> unit(0, 1);
  std::vector<double> gain(views.front().size(), 1.0);
  std::vector<double> plus(views.front().size(), dirt.background * peak);
  for (int n = 0; n < dirt.specks; ++n) {
    const double x = unit(random) * bench.columns;
    const double y = unit(random) * bench.rows;
    const double radius = 1 + 2 * unit(random);
    const bool bright = n % 2 == 0;
    const double strength = 0.2 + 0.8 * unit(random);
    for (int r = 0; r < bench.rows; ++r) {
      for (int c = 0; c < bench.columns; ++c) {
        if (std::hypot(c - x, r - y) > radius) continue;
        const auto at =
            static_cast<std::size_t>(r) * static_cast<std::size_t>(bench.columns) + static_cast<std::size_t>(c);
        if (bright) plus[at] += strength * peak;
        if (!bright) gain[at] *= 1 - strength;
      }
    }
  }
  std::normal_distribution<double> normal(0, 1);
  for (auto& view : views) {
    const double light = dirt.flicker > 0 ? std::max(0.1, 1 + dirt.flicker * normal(random)) : 1.0;
    for (std::size_t i = 0; i < view.size(); ++i) {
      const double noise = dirt.noise > 0 ? dirt.noise * peak * normal(random) : 0.0;
      view[i] = static_cast<float>(light * gain[i] * static_cast<double>(view[i]) + plus[i] + noise);
    }
  }
}

std::vector<Bubble> bubbles(int count, double reach_mm, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(0, 1);
  std::vector<Bubble> all;
  for (int n = 0; n < count; ++n) {
    const double radius = 0.15 + 0.25 * unit(random);
    const double r = reach_mm * std::sqrt(unit(random));
    const double angle = 2 * std::numbers::pi * unit(random);
    const double bright_mm = 2 + 8 * unit(random);
    Bubble bubble;
    bubble.body = {Body::Kind::ball,
                   {r * std::cos(angle), r * std::sin(angle), 14 * unit(random) - 10},
                   {radius, 0, 0},
                   bright_mm / (2 * radius)};
    bubble.rise_mm = 3 + 7 * unit(random);
    bubble.carried = unit(random);
    all.push_back(bubble);
  }
  return all;
}

double distance_mm(const std::vector<Body>& bodies, const Place& point) {
  double nearest = 1e9;
  for (const Body& body : bodies) {
    if (body.density > 0) nearest = std::min(nearest, body_distance(body, point));
  }
  for (const Body& body : bodies) {
    if (body.density < 0) nearest = std::max(nearest, -body_distance(body, point));
  }
  return nearest;
}

}  // namespace vam::oracle
