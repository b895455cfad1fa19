// SPDX-License-Identifier: GPL-3.0-or-later
#include "sim/bench/scene.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "base/constants.hpp"
#include "base/image.hpp"
#include "base/index.hpp"
#include "base/random.hpp"
#include "base/stats/distributions.hpp"
#include "sim/bench/print.hpp"
#include "sim/bench/private/beams.hpp"
#include "sim/bench/private/sight_lines.hpp"

namespace vam::sim {

namespace {

/// Height at the axis of a ray that leaves the camera with a slope of 1: n times the slope is conserved from layer to
/// layer [physics §2].
double height_at_axis_mm(const model::Printer& printer) {
  const double inner_mm = model::resin_radius_mm(printer.vial);
  const double window_mm = printer.bath.index == 1 ? printer.vial.radius_mm : printer.bath.window_mm;
  return printer.camera.distance_mm - window_mm + (window_mm - printer.vial.radius_mm) / printer.bath.index +
         (printer.vial.radius_mm - inner_mm) / printer.vial.index_glass + inner_mm / printer.camera.index_resin;
}

constexpr int rays_a_column = 5;         // of the camera
constexpr int most_blurs = 9;            // widths of the beam between its narrowest and its widest place
constexpr double scatter_per_mm = 0.08;  // of full scale
constexpr double most_speck = 0.2;       // of full scale
constexpr double reference_us = 20000;

// Unit normal deviate of a pixel, always the same (Box-Muller).
double normal(std::uint64_t key) {
  const std::uint64_t first = scrambled(key);
  const double radius = std::sqrt(-2 * std::log(1 - unit_interval(first)));
  return radius * std::cos(2 * std::numbers::pi * unit_interval(scrambled(first)));
}

// What a camera column sees: its chief ray in the resin, and what each of the projector's sheets of light gives it.
struct ColumnSight {
  SimRay ray;
  std::vector<float> gains;  // for full light
  std::vector<float> blurs;  // which of the beam's widths it has, between two of them
};

// Dirt that stays in the image.
struct SimSpeck {
  double column, row, radius_px;
  double light;  // of full scale
};

void add_specks(const std::vector<SimSpeck>& specks, Image& light) {
  for (const SimSpeck& speck : specks) {
    for (int r = 0; r < light.height; ++r) {
      if (std::abs(r - speck.row) > speck.radius_px) continue;
      for (int c = 0; c < light.width; ++c) {
        if (std::hypot(c - speck.column, r - speck.row) <= speck.radius_px) {
          light(c, r) += static_cast<float>(speck.light);
        }
      }
    }
  }
}

}  // namespace

struct SimScene::State {
  SimBench bench;
  int columns = 0;
  int rows = 0;
  int bits = 8;
  double pixel_mm = 0;
  SimBeams beams;
  std::vector<double> blurs_px;     // standard deviations of the beam, from its focus outwards
  double furthest_mm = 0;           // from the focus to the end of the resin
  std::vector<ColumnSight> sights;  // of each column
  std::optional<SightLines> lines;  // to what light has cured
  std::vector<SimSpeck> specks;

  State(const SimBench& about, int binning, int depth) : bench(about), bits(depth), beams(about.printer) {
    columns = bench.columns / binning;
    rows = bench.rows / binning;
    pixel_mm = bench.printer.camera.pixel_mm * binning;
    furthest_mm = model::resin_radius_mm(bench.printer.vial) + std::abs(bench.focus_mm);
    const int blurs = bench.divergence_deg > 0 ? most_blurs : 1;
    for (int i = 0; i < blurs; ++i) {
      const double spread_mm = furthest_mm * i / (most_blurs - 1) * std::tan(bench.divergence_deg * rad_per_deg);
      blurs_px.push_back(std::hypot(bench.beam_mm, spread_mm) / stats::fwhm_per_sigma /
                         bench.printer.projector.pixel_mm);
    }
    const auto to_camera = outer_shells(bench.printer, bench.printer.camera.index_resin);
    for (int c = 0; c < columns; ++c) sights.push_back(sight(c, to_camera));
    if (bench.resin) lines.emplace(bench.printer, columns, rows, pixel_mm);
    for (int n = 0; n < bench.specks; ++n) specks.push_back(speck(n));
  }

  // Bright or dark, of one to three pixels.
  [[nodiscard]] SimSpeck speck(int n) const {
    std::uint64_t key = scrambled(static_cast<std::uint64_t>(bench.seed) << 32 ^ static_cast<std::uint64_t>(n));
    const auto next = [&key] { return unit_interval(key = scrambled(key)); };
    SimSpeck made{next() * columns, next() * rows, 0.5 + next(), 0};
    made.light = (next() < 0.5 ? -0.5 : 1) * most_speck * next();
    return made;
  }

  [[nodiscard]] ColumnSight sight(int column, const SimShells& shells) const {
    const auto ray_at = [&](double place) {
      return sim_ray((place - 0.5 * (columns - 1)) * pixel_mm, bench.printer.camera.distance_mm, shells);
    };
    const std::size_t sheets = beams.columns().size() - 1;
    ColumnSight seen{ray_at(column), std::vector<float>(sheets), std::vector<float>(sheets)};
    const double diameter_mm = 2 * model::resin_radius_mm(bench.printer.vial);
    for (int i = 0; i < rays_a_column; ++i) {
      const SimRay ray = ray_at(column + (i + 0.5) / rays_a_column - 0.5);
      const auto crossings = beams.along(ray, bench.printer.camera.azimuth_deg * rad_per_deg);
      const double gain = bench.glow * ray.transmittance / diameter_mm / rays_a_column;
      for (std::size_t k = 0; k < sheets; ++k) {
        seen.gains[k] += static_cast<float>(gain * crossings[k].path_mm);
        const double blur = std::abs(crossings[k].y_mm - bench.focus_mm) / furthest_mm * (most_blurs - 1);
        seen.blurs[k] += static_cast<float>(blur / rays_a_column);
      }
    }
    return seen;
  }

  // Light that reaches the camera from the resin, by camera column, when the vial stands `shift` columns to the right;
  // lit: by the beam's width.
  [[nodiscard]] std::vector<double> glow(const std::vector<LitRow>& lit, double shift) const {
    const auto& ends = beams.columns();
    std::vector<std::vector<double>> sheets(lit.size());
    std::vector<std::size_t> bright;  // the others give nothing
    for (std::size_t k = 0; k + 1 < ends.size(); ++k) {
      for (std::size_t b = 0; b < lit.size(); ++b) {
        sheets[b].push_back(lit[b].mean(ends[k] + shift, ends[k + 1] + shift));
        if (sheets[b][k] != 0 && (bright.empty() || bright.back() != k)) bright.push_back(k);
      }
    }
    std::vector<double> light(columns);
    for (std::size_t c = 0; c < light.size(); ++c) {
      const ColumnSight& seen = sights[c];
      for (const std::size_t k : bright) {
        const auto narrow = std::min(static_cast<std::size_t>(seen.blurs[k]), lit.size() - 1);
        const auto wide = std::min(narrow + 1, lit.size() - 1);
        const double part = seen.blurs[k] - static_cast<double>(narrow);
        light[c] += seen.gains[k] * ((1 - part) * sheets[narrow][k] + part * sheets[wide][k]);
      }
    }
    return light;
  }

  // The chief ray between two columns.
  [[nodiscard]] SimRay ray_at(double column) const {
    const auto left = static_cast<std::size_t>(std::clamp(std::floor(column), 0.0, columns - 2.0));
    const double part = column - static_cast<double>(left);
    const SimRay& a = sights[left].ray;
    const SimRay& b = sights[left + 1].ray;
    if (!a.enters || !b.enters || part < 0 || part > 1) return {};
    const auto between = [part](double one, double other) { return one + part * (other - one); };
    return {true, between(a.offset_mm, b.offset_mm), between(a.turn_rad, b.turn_rad),
            between(a.transmittance, b.transmittance)};
  }

  [[nodiscard]] double printed(double column, double z_mm, double angle_deg, double growth) const {
    const SimRay ray = ray_at(column);
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

// Rows of camera pixels that see the same rows of the image glow alike.
class GlowingRow {
 public:
  GlowingRow(const SimScene::State& scene, const GreyImage* image, double shift)
      : scene_(scene), shift_(shift), light_(scene.columns) {
    if (image != nullptr) image_.emplace(*image, scene.bench.gamma);
  }
  // Between two heights, top first.
  const std::vector<double>& light(double top_mm, double bottom_mm) {
    if (!image_) return light_;
    const auto& projector = scene_.bench.printer.projector;
    const double top = projector.axis_row - top_mm / projector.pixel_mm;
    const double bottom = projector.axis_row - bottom_mm / projector.pixel_mm;
    const int twin = image_->uniform(top, bottom, scene_.blurs_px.back());
    if (twin < 0 || twin != twin_) {
      std::vector<LitRow> lit;
      for (const double blur : scene_.blurs_px) lit.push_back(image_->between(top, bottom, blur));
      light_ = scene_.glow(lit, shift_);
    }
    twin_ = twin;
    return light_;
  }

 private:
  const SimScene::State& scene_;
  double shift_;
  std::optional<LitImage> image_;
  std::vector<double> light_;
  int twin_ = -1;
};

Image SimScene::State::light(const SimMoment& moment) const {
  const auto& printer = bench.printer;
  Image image(columns, rows);
  if (bench.card) {
    const double even = moment.image == nullptr ? 0 : LitImage(*moment.image, bench.gamma).mean();
    std::fill(image.values.begin(), image.values.end(), static_cast<float>(bench.glow * even));
    return image;
  }
  const double growth = bench.lit_s > 0 ? std::cbrt(std::clamp(moment.lit_s / bench.lit_s, 0.0, 1.0)) : 1.0;
  const double seat_rad = (moment.angle_deg - bench.wobble_deg) * rad_per_deg;
  const double aside_mm = bench.wobble_mm * std::cos(seat_rad);   // along the projector's columns
  const double along_mm = bench.wobble_mm * -std::sin(seat_rad);  // along its light
  const double azimuth = printer.camera.azimuth_deg * rad_per_deg;
  const double seen_mm = aside_mm * std::cos(azimuth) + along_mm * std::sin(azimuth);
  // Heights in the vial look enlarged [OST22 eq S6].
  const double enlarged = printer.camera.distance_mm / height_at_axis_mm(printer);
  Image cured;
  if (moment.print != nullptr) cured = lines->view(moment.print->resin(), moment.print->part_rad(moment.angle_deg));
  GlowingRow glowing(*this, bench.glow > 0 ? moment.image : nullptr,
                     bench.centre_px + aside_mm / printer.projector.pixel_mm);
  for (int r = 0; r < rows; ++r) {
    const double z_mm = (0.5 * (rows - 1) - r) * pixel_mm / enlarged;
    const double half_mm = 0.5 * pixel_mm / enlarged;
    const double moved_px = (bench.axis_column * printer.camera.pixel_mm + seen_mm) / pixel_mm +
                            std::tan(bench.tilt_deg * rad_per_deg) * (r - 0.5 * (rows - 1));
    const std::vector<double>& row_glow = glowing.light(z_mm + half_mm, z_mm - half_mm);
    for (int c = 0; c < columns; ++c) {
      // The image of a vial that stands moved_px to the right, between two computed columns.
      const double from = c - moved_px;
      const auto left = floor_int(from);
      const double part = from - left;
      double value = moment.print == nullptr ? printed(from, z_mm, moment.angle_deg, growth) : 0;
      for (const auto& [column, weight] : {std::pair(left, 1 - part), std::pair(left + 1, part)}) {
        if (column < 0 || column >= columns) continue;
        value += weight * row_glow[column];
        if (moment.print != nullptr) value += weight * scatter_per_mm * cured(column, r);
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
  return render(std::vector{moment}, exposure_us, number);
}

GreyImage SimScene::render(const std::vector<SimMoment>& exposure, double exposure_us, long number) const {
  const State& s = *state_;
  Image light(s.columns, s.rows);
  for (const SimMoment& moment : exposure) {
    const Image part = s.light(moment);
    for (std::size_t i = 0; i < light.size(); ++i) {
      light.values[i] += static_cast<float>(moment.share) * part.values[i];
    }
  }
  add_specks(s.specks, light);
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

}  // namespace vam::sim
