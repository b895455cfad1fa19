#include "light/lit_table.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "base/parallel.hpp"

namespace vam::light {

namespace {

constexpr double turn_rad = 2 * std::numbers::pi;
constexpr int least_directions = 1440;  // alpha in steps of at most 0.25 deg: column to 1e-3 at 400 columns radius
constexpr int samples_per_step = 8;     // rays per step of alpha where the map folds
constexpr int most_sheets = 4;          // front; rear: fold, middle, fold
constexpr double rim = 1 - 1e-9;        // rays at the very rim graze the glass and carry no light

}  // namespace

// The ray map on a circle of the lab: everything at angle b from the ray's own normal.
struct LitTable::Light {
  const optics::View& view;
  double absorption_per_mm;
  double edge_mm;
  double reach_mm;

  struct Point {
    double alpha = 0;
    double alpha_rate = 1;  // d alpha / d b = 1 - u (d delta / d x_p) / J
    double x_p_mm = 0;
    double strength = 0;  // T / J e^{-mu s}, still per d b
  };

  [[nodiscard]] Point at(double r, double b) const {
    const double t = std::clamp(r * std::cos(b), -rim * reach_mm, rim * reach_mm);
    const double u = r * std::sin(b);
    const double x_p = optics::column_of(view, t).value_or(0);
    const optics::ChiefRay ray = optics::chief_ray(view, x_p);
    const double s = std::sqrt(edge_mm * edge_mm - t * t) + u;
    return {b + ray.delta_rad, 1 - u * ray.delta_rate / ray.jacobian, x_p,
            ray.transmittance / ray.jacobian * std::exp(-absorption_per_mm * s)};
  }
};

LitTable::LitTable(const optics::View& view, int stage_angles, int sense, double absorption_per_mm, double r_max_mm,
                   double pitch_mm)
    : angles(stage_angles),
      phases((least_directions + stage_angles - 1) / stage_angles),
      length(2 * stage_angles + 1),
      reach_mm(optics::reach_mm(view)),
      edge_mm(optics::resin_radius_mm(view)),
      sense_(sense) {
  const Light light{view, absorption_per_mm, edge_mm, reach_mm};
  const auto allocate = [&](Zone& zone) {
    zone.x_p_mm.resize(series(zone, zone.rows, 0, 0));
    zone.strength.resize(zone.x_p_mm.size());
  };
  const double inside = std::min(reach_mm * rim, std::max(r_max_mm, pitch_mm));
  inner.rows = std::max(2, static_cast<int>(std::ceil(inside / pitch_mm)) + 1);
  inner.pitch_mm = inside / (inner.rows - 1);
  allocate(inner);
  parallel_for(inner.rows, [&](int row) { fill_inner_row(light, row); });

  const double beyond = std::min(edge_mm, r_max_mm) - reach_mm;
  if (!(beyond > 0)) return;
  outer.sheets = most_sheets;
  outer.rows = static_cast<int>(std::ceil(2 * beyond / pitch_mm));  // nearest row: half the pitch
  outer.pitch_mm = beyond / outer.rows;
  outer.first_mm = reach_mm + 0.5 * outer.pitch_mm;
  allocate(outer);
  parallel_for(outer.rows, [&](int row) { fill_outer_row(light, row); });
}

void LitTable::store(Zone& zone, int row, int sheet, int index, double x_p_mm, double strength) {
  const int phase = index % phases;
  for (int i = index / phases; i < length; i += angles) {
    const std::size_t at = series(zone, row, sheet, phase) + static_cast<std::size_t>(i);
    zone.x_p_mm[at] = static_cast<float>(x_p_mm);
    zone.strength[at] = static_cast<float>(strength);
  }
}

void LitTable::fill_inner_row(const Light& light, int row) {
  const double r = row * inner.pitch_mm;
  double b = 0;
  for (int index = 0; index < angles * phases; ++index) {
    const double alpha = sense_ * index * turn_rad / (angles * phases);
    // alpha(b) is monotone here, and the neighbour's b is a near guess: a few steps. Halving guards the rim, where
    // delta is steepest.
    Light::Point point = light.at(r, b);
    for (int step = 0; step < 60 && std::abs(alpha - point.alpha) > 1e-12; ++step) {
      const double limit = 0.25 / (1 + step);
      b += std::clamp((alpha - point.alpha) / point.alpha_rate, -limit, limit);
      point = light.at(r, b);
    }
    store(inner, row, 0, index, point.x_p_mm, point.strength / point.alpha_rate);
  }
}

void LitTable::fill_outer_row(const Light& light, int row) {
  const int directions = angles * phases;
  const double r = outer.first_mm + row * outer.pitch_mm;
  const double open = std::acos(std::min(1.0, rim * reach_mm / r));  // rays reach b in (open, pi - open) and opposite
  struct Cell {
    double strength = 0;
    double moment = 0;
  };
  std::array<std::vector<Cell>, most_sheets> sheets;
  for (auto& sheet : sheets) sheet.resize(static_cast<std::size_t>(directions));

  const double arc = std::numbers::pi - 2 * open;
  const int samples = std::max(8, static_cast<int>(std::ceil(samples_per_step * directions * arc / turn_rad)));
  const double step = arc / samples;
  for (const bool front : {true, false}) {  // light enters at u < 0
    int sheet = front ? 0 : 1;
    bool rising = true;
    for (int k = 0; k < samples; ++k) {
      const double b = (front ? -std::numbers::pi : 0.0) + open + (k + 0.5) * step;
      const Light::Point point = light.at(r, b);
      if (k == 0) rising = point.alpha_rate > 0;
      if ((point.alpha_rate > 0) != rising) {  // a fold
        rising = !rising;
        sheet = std::min(sheet + 1, most_sheets - 1);
      }
      const double light_here = point.strength * step * directions / turn_rad;
      const double place = sense_ * point.alpha * directions / turn_rad;
      const double below = std::floor(place);
      for (const int side : {0, 1}) {  // shared by the two nearest directions
        const double share = light_here * (side == 1 ? place - below : 1 - (place - below));
        const int index = (static_cast<int>(below) + side) % directions;
        Cell& cell =
            sheets[static_cast<std::size_t>(sheet)][static_cast<std::size_t>((index + directions) % directions)];
        cell.strength += share;
        cell.moment += share * point.x_p_mm;
      }
    }
  }
  for (int sheet = 0; sheet < most_sheets; ++sheet) {
    const std::vector<Cell>& cells = sheets[static_cast<std::size_t>(sheet)];
    const auto cell = [&](int index) { return cells[static_cast<std::size_t>((index + directions) % directions)]; };
    for (int index = 0; index < directions; ++index) {
      // A direction without a ray takes its neighbour's column, so that interpolation to it only fades.
      Cell source = cell(index);
      for (const int neighbour : {-1, 1}) {
        if (source.strength == 0) source = cell(index + neighbour);
      }
      const double x_p = source.strength > 0 ? source.moment / source.strength : 0;
      store(outer, row, sheet, index, x_p, cell(index).strength);
    }
  }
}

}  // namespace vam::light
