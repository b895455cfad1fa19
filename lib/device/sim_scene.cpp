#include "device/sim_scene.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <numbers>

#include "base/constants.hpp"
#include "base/error.hpp"
#include "base/image.hpp"
#include "base/text.hpp"
#include "device/sim_ray.hpp"

namespace vam::device {

namespace {

constexpr int beams_a_column = 8;
constexpr int steps = 160;               // along a camera ray through the resin
constexpr double scatter_per_mm = 0.08;  // of full scale
constexpr double reference_us = 20000;

// Unit normal deviate of a pixel, always the same (splitmix64 and Box-Muller).
double normal(std::uint64_t key) {
  const auto next = [&key] {
    std::uint64_t z = (key += 0x9e3779b97f4a7c15ULL);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
    return (static_cast<double>((z ^ (z >> 31)) >> 11) + 0.5) * 0x1p-53;
  };
  const double radius = std::sqrt(-2 * std::log(next()));
  return radius * std::cos(2 * std::numbers::pi * next());
}

// Running sum of a projector row's intensity: the light between two fractional columns is a difference.
struct LitRow {
  std::vector<double> sum;
  [[nodiscard]] double upto(double column) const {  // integral over columns -0.5 ... column
    const double at = std::clamp(column + 0.5, 0.0, static_cast<double>(sum.size() - 1));
    const auto below = std::min(static_cast<std::size_t>(at), sum.size() - 2);
    return sum[below] + (at - static_cast<double>(below)) * (sum[below + 1] - sum[below]);
  }
  // Mean over from ... to, at least `width` wide about its middle.
  [[nodiscard]] double mean(double from, double to, double width) const {
    const double middle = 0.5 * (from + to);
    const double half = 0.5 * std::max({std::abs(to - from), width, 1e-6});
    return (upto(middle + half) - upto(middle - half)) / (2 * half);
  }
};

double chord_mm(const SimBody& body, double growth, double z_mm, double distance_mm) {
  const double radius = body.radius_mm * growth;
  double square = radius * radius - distance_mm * distance_mm;
  if (body.height_mm > 0) {
    if (std::abs(z_mm - body.z_mm) > 0.5 * body.height_mm) return 0;
  } else {
    square -= (z_mm - body.z_mm) * (z_mm - body.z_mm);
  }
  return square > 0 ? 2 * std::sqrt(square) : 0;
}

}  // namespace

namespace {

// One key=value of a body; false when it is none.
bool set_key(SimBody& body, bool cylinder, const std::string& pair) {
  const std::size_t equals = pair.find('=');
  if (equals == std::string::npos) return false;
  const double value = parse_number(pair.substr(equals + 1)).value_or(NAN);
  const std::string key = pair.substr(0, equals);
  if (!std::isfinite(value)) return false;
  const std::map<std::string, double*> places{{"x", &body.x_mm}, {"y", &body.y_mm}, {"z", &body.z_mm}};
  if (const auto place = places.find(key); place != places.end()) {
    *place->second = value;
    return true;
  }
  if (value <= 0) return false;
  if (key == "diameter") body.radius_mm = 0.5 * value;
  if (key == "height") body.height_mm = value;
  return key == "diameter" || (key == "height" && cylinder);
}

}  // namespace

std::vector<SimBody> parse_bodies(const std::string& text) {
  std::vector<SimBody> bodies;
  for (const auto& one : split(text, ';')) {
    const std::size_t colon = std::min(one.find(':'), one.size());
    const std::string kind = one.substr(0, colon);
    SimBody body;
    if (kind == "cylinder") body.height_mm = 4;
    bool good = kind == "sphere" || kind == "cylinder";
    for (const auto& pair : split(colon == one.size() ? "" : one.substr(colon + 1), ',')) {
      good = good && set_key(body, kind == "cylinder", pair);
    }
    if (!good) {
      throw Error{Fault::usage, "part '" + one + "': not like sphere:x=2,diameter=4 or cylinder:diameter=6,height=3"};
    }
    bodies.push_back(body);
  }
  return bodies;
}

// Where the ray of a camera column runs in the resin, in the frame of the lab, and what light crosses it.
struct Sight {
  SimRay ray;
  std::vector<double> edges;   // projector column at the ends of the steps; empty without resin
  std::vector<double> widths;  // of the beam there, in columns, at the middle of each step
  std::vector<double> gains;   // part of the light that gets there
  double weight = 0;           // of each step: its length over the vial's diameter, times what the camera gets of it
};

struct SimScene::State {
  SimBench bench;
  int columns = 0;
  int rows = 0;
  int bits = 8;
  double pixel_mm = 0;
  std::vector<Sight> sights;
  std::vector<SimRay> beams;   // beams_a_column of them, from the outer edge of the first column on
  std::size_t first_beam = 0;  // that enters the resin
  std::size_t last_beam = 0;

  State(const SimBench& about, int binning, int depth) : bench(about), bits(depth) {
    columns = bench.columns / binning;
    rows = bench.rows / binning;
    pixel_mm = bench.printer.camera.pixel_mm * binning;
    const auto& projector = bench.printer.projector;
    const auto outside = outer_shells(bench.printer, bench.printer.resin.index);
    const auto distance_mm = model::lens_distance_mm(projector);
    for (int i = 0; i <= projector.columns * beams_a_column; ++i) {
      const double column = static_cast<double>(i) / beams_a_column - 0.5;
      beams.push_back(sim_ray((column - projector.axis_column) * projector.pixel_mm, distance_mm, outside));
    }
    while (first_beam + 1 < beams.size() && !beams[first_beam].enters) ++first_beam;
    last_beam = beams.size() - 1;
    while (last_beam > first_beam && !beams[last_beam].enters) --last_beam;
    const auto to_camera = outer_shells(bench.printer, bench.printer.camera.index_resin);
    for (int c = 0; c < columns; ++c) {
      const double x_mm = (c - 0.5 * (columns - 1)) * pixel_mm;
      sights.push_back(sight(sim_ray(x_mm, bench.printer.camera.distance_mm, to_camera)));
    }
  }

  Sight sight(const SimRay& ray) const {
    Sight seen{ray, {}, {}, {}, 0};
    if (!ray.enters) return seen;
    const double radius_mm = model::resin_radius_mm(bench.printer.vial);
    const double half_mm = std::sqrt(std::max(0.0, radius_mm * radius_mm - ray.offset_mm * ray.offset_mm));
    const double turn = ray.turn_rad + bench.printer.camera.azimuth_deg * rad_per_deg;
    const double pixel = bench.printer.projector.pixel_mm;
    double before = 0;
    for (int i = 0; i <= steps; ++i) {
      const double u = half_mm * (2.0 * i / steps - 1);
      const double x = ray.offset_mm * std::cos(turn) - u * std::sin(turn);
      const double y = ray.offset_mm * std::sin(turn) + u * std::cos(turn);
      const Crossing here = crossing(x, y);
      seen.edges.push_back(here.column);
      if (i > 0) seen.gains.push_back(0.5 * (before + here.irradiance));
      before = here.irradiance;
      if (i < steps) {
        const double spread = 2 * std::abs(y) * std::tan(bench.divergence_deg * rad_per_deg);
        seen.widths.push_back(std::hypot(bench.beam_mm, spread) / pixel);
      }
    }
    seen.weight = ray.transmittance * half_mm / (steps * radius_mm);
    return seen;
  }

  // The projector column (fractional) whose ray goes through a point of the resin, and the light there, of that in the
  // plane of the axis without a vial: rays that come closer together are brighter. 0 where none comes.
  struct Crossing {
    double column = 0;
    double irradiance = 0;
  };
  [[nodiscard]] Crossing crossing(double x, double y) const {
    const auto beyond = [&](const SimRay& beam) {  // how far the point is on the side of the higher columns
      return x * std::cos(beam.turn_rad) + y * std::sin(beam.turn_rad) - beam.offset_mm;
    };
    const auto column = [](std::size_t beam) { return static_cast<double>(beam) / beams_a_column - 0.5; };
    std::size_t low = first_beam;
    std::size_t high = last_beam;
    if (beyond(beams[low]) < 0) return {column(low), 0};
    if (beyond(beams[high]) > 0) return {column(high), 0};
    while (high - low > 1) {
      const std::size_t middle = (low + high) / 2;
      (beyond(beams[middle]) >= 0 ? low : high) = middle;
    }
    const double apart_mm = beyond(beams[low]) - beyond(beams[high]);
    const double part = beyond(beams[low]) / std::max(apart_mm, 1e-9);
    const double even_mm = bench.printer.projector.pixel_mm / beams_a_column;
    const double through = (1 - part) * beams[low].transmittance + part * beams[high].transmittance;
    return {column(low) + part / beams_a_column, through * std::min(even_mm / std::max(apart_mm, 1e-9), 20.0)};
  }

  [[nodiscard]] LitRow lit_row(const GreyImage& picture, int row) const {
    LitRow lit;
    lit.sum.assign(static_cast<std::size_t>(picture.width) + 1, 0);
    for (int c = 0; c < picture.width; ++c) {
      const double grey = static_cast<double>(picture(c, row)) / picture.full();
      const auto at = static_cast<std::size_t>(c);
      lit.sum[at + 1] = lit.sum[at] + (grey > 0 ? std::pow(grey, bench.gamma) : 0);
    }
    return lit;
  }

  // Light that the camera gets out of the resin, by camera column, when the vial stands `shift` columns to the right.
  [[nodiscard]] std::vector<double> glow(const LitRow& lit, double shift) const {
    std::vector<double> light(static_cast<std::size_t>(columns));
    for (std::size_t c = 0; c < light.size(); ++c) {
      const Sight& seen = sights[c];
      double sum = 0;
      for (std::size_t i = 0; i + 1 < seen.edges.size(); ++i) {
        sum += seen.gains[i] * lit.mean(seen.edges[i] + shift, seen.edges[i + 1] + shift, seen.widths[i]);
      }
      light[c] = bench.glow * seen.weight * sum;
    }
    return light;
  }

  [[nodiscard]] double printed(std::size_t column, double z_mm, double angle_deg, double growth) const {
    const SimRay& ray = sights[column].ray;
    if (!ray.enters || growth <= 0) return 0;
    const double turn = ray.turn_rad + (angle_deg + bench.printer.camera.azimuth_deg) * rad_per_deg;
    double sum_mm = 0;
    for (const SimBody& body : bench.bodies) {
      const double distance = body.x_mm * std::cos(turn) + body.y_mm * std::sin(turn) - ray.offset_mm;
      sum_mm += chord_mm(body, growth, z_mm, distance);
    }
    return scatter_per_mm * sum_mm * ray.transmittance;
  }

  [[nodiscard]] Image light(const SimMoment& moment) const;
};

Image SimScene::State::light(const SimMoment& moment) const {
  const auto& printer = bench.printer;
  const double growth = std::cbrt(std::clamp(moment.lit_s / bench.lit_s, 0.0, 1.0));
  const double seat_rad = (moment.angle_deg - bench.wobble_deg) * rad_per_deg;
  const double aside_mm = bench.wobble_mm * std::cos(seat_rad);   // along the projector's columns
  const double along_mm = bench.wobble_mm * -std::sin(seat_rad);  // along its light
  const double azimuth = printer.camera.azimuth_deg * rad_per_deg;
  const double seen_mm = aside_mm * std::cos(azimuth) + along_mm * std::sin(azimuth);
  const double to_projector = bench.centre_px + aside_mm / printer.projector.pixel_mm;
  // Heights in the vial look enlarged [OST22 eq S5].
  const double enlarged = 1 / (1 - printer.vial.radius_mm * (1 - printer.bath.index / printer.camera.index_resin) /
                                       printer.camera.distance_mm);
  Image image(columns, rows);
  std::vector<double> row_glow(static_cast<std::size_t>(columns), 0);
  int glowing_row = -1;
  for (int r = 0; r < rows; ++r) {
    const double z_mm = (0.5 * (rows - 1) - r) * pixel_mm / enlarged;
    const double moved_px = (bench.axis_column * printer.camera.pixel_mm + seen_mm) / pixel_mm +
                            std::tan(bench.tilt_deg * rad_per_deg) * (r - 0.5 * (rows - 1));
    if (moment.picture != nullptr) {
      const auto lit = static_cast<int>(std::lround(printer.projector.axis_row - z_mm / printer.projector.pixel_mm));
      const int row = std::clamp(lit, 0, moment.picture->height - 1);
      const auto width = static_cast<std::size_t>(moment.picture->width);
      const auto* values = moment.picture->values.data();
      const bool same = glowing_row >= 0 && std::equal(values + static_cast<std::size_t>(row) * width,
                                                       values + static_cast<std::size_t>(row + 1) * width,
                                                       values + static_cast<std::size_t>(glowing_row) * width);
      if (!same) row_glow = glow(lit_row(*moment.picture, row), to_projector);
      glowing_row = row;
    }
    for (int c = 0; c < columns; ++c) {
      // The picture of a vial that stands moved_px to the right, between two computed columns.
      const double from = c - moved_px;
      const auto left = static_cast<int>(std::floor(from));
      const double part = from - left;
      double value = 0;
      for (const auto& [column, weight] : {std::pair(left, 1 - part), std::pair(left + 1, part)}) {
        if (column < 0 || column >= columns) continue;
        const auto at = static_cast<std::size_t>(column);
        value += weight * (row_glow[at] + printed(at, z_mm, moment.angle_deg, growth));
      }
      image(c, r) = static_cast<float>(value);
    }
  }
  return image;
}

SimScene::SimScene(const SimBench& bench, int binning, int bits)
    : state_(std::make_unique<State>(bench, binning, bits)) {}
SimScene::~SimScene() = default;
int SimScene::columns() const { return state_->columns; }
int SimScene::rows() const { return state_->rows; }

GreyImage SimScene::render(const SimMoment& moment, double exposure_us, long number) const {
  const State& s = *state_;
  const Image light = s.light(moment);
  GreyImage levels(s.columns, s.rows, s.bits);
  const double gain = exposure_us / reference_us;
  const double reach = 0.25 * (s.columns * s.columns + s.rows * s.rows);
  for (int r = 0; r < s.rows; ++r) {
    for (int c = 0; c < s.columns; ++c) {
      const double dx = c - 0.5 * (s.columns - 1);
      const double dy = r - 0.5 * (s.rows - 1);
      double value = gain * light(c, r) * (1 - s.bench.vignetting * (dx * dx + dy * dy) / reach) + s.bench.background;
      if (s.bench.noise > 0) {
        const auto key = static_cast<std::uint64_t>(s.bench.seed) << 48 ^ static_cast<std::uint64_t>(number) << 24 ^
                         levels.index(c, r);
        value += s.bench.noise * normal(key);
      }
      levels(c, r) = static_cast<std::uint16_t>(std::lround(std::clamp(value, 0.0, 1.0) * levels.full()));
    }
  }
  return levels;
}

}  // namespace vam::device
