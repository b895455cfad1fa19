// SPDX-License-Identifier: GPL-3.0-or-later
#include "metrology/cure/curing_curve.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/error.hpp"
#include "base/index.hpp"
#include "base/stats/curve_fit.hpp"
#include "base/text/json.hpp"
#include "base/text/text.hpp"
#include "model/value_at.hpp"

namespace vam::metrology {

namespace {

constexpr double least_share = 0.1;   // of the highest dose
constexpr double least_sigma = 0.01;  // of the highest scatter: what sigmas do not contain, as streaks
// Voxels whose noise is one: a voxel and its neighbours, over which rays are interpolated and filtered.
constexpr double together = 27;
// Share of the dose at half of the saturation that the inhibitor takes, which the readings hardly show: between these.
constexpr std::array<double, 3> inhibited{0.5, 0.2, 0.8};

struct DoseClass {
  double dose = 0, scatter = 0, squares = 0;
  double voxels = 0;
};

// S, D_0 and w (by its logarithm) of S / (1 + e^{-(D - D_0) / w}), and the delay in turns.
struct Curve {
  double saturation, middle, width, delay, inhibition;
  Curve(const std::vector<double>& p, double inhibited_share)
      : saturation(p[0]),
        middle(p[1]),
        width(std::exp(p[2])),
        delay(p.size() > 3 ? p[3] : 0),
        inhibition(inhibited_share * middle) {}

  // A volume is that of the middle of its turn.
  [[nodiscard]] double density(const CuringReading& reading, double lit_turns) const {
    const double turn = 0.5 * (reading.first_turn + reading.last_turn);
    const double dose = dose_that_has_acted(reading.dose_per_turn_mj_cm3, turn, lit_turns);
    return saturation / (1 + std::exp((middle - dose) / width));
  }

  // Radicals, which live for the delay, come up after the inhibitor, and act on after the light.
  [[nodiscard]] double dose_that_has_acted(double per_turn, double turn, double lit_turns) const {
    const double given = per_turn * std::clamp(turn, 0.0, lit_turns);
    const double lit = std::min(turn, lit_turns) - inhibition / per_turn;
    if (!(lit > 0)) return given;
    const double lifetime = std::max(std::abs(delay), 1e-9);  // noise can make the delay of a prompt resin negative
    const double lacking = -std::expm1(-lit / lifetime) * std::exp(-std::max(0.0, turn - lit_turns) / lifetime);
    return given - per_turn * delay * lacking;
  }
};

double dose_of(const CuringReading& reading, double lit_turns) {
  return reading.dose_per_turn_mj_cm3 * std::min(lit_turns, 0.5 * (reading.first_turn + reading.last_turn));
}

// Half of the highest density is near the middle; the rise takes a few tenths of the dose.
std::vector<double> beginning(const std::vector<CuringReading>& readings, double lit_turns, bool delayed) {
  double most = 0;
  for (const CuringReading& reading : readings) most = std::max(most, reading.scatter);
  double nearest = most;
  double middle = 0;
  for (const CuringReading& reading : readings) {
    const double off = std::abs(reading.scatter - 0.5 * most);
    if (off >= nearest) continue;
    nearest = off;
    middle = dose_of(reading, lit_turns);
  }
  if (!(middle > 0)) throw Error{Fault::data, "working curve: nothing scatters; give the resin more light"};
  std::vector<double> start{most, middle, std::log(0.1 * middle)};
  if (delayed) start.push_back(0.05);
  return start;
}

void require_rise(const std::vector<CuringReading>& readings, double saturation) {
  const auto below = std::count_if(readings.begin(), readings.end(),
                                   [&](const CuringReading& r) { return r.scatter < 0.25 * saturation; });
  const auto above = std::count_if(readings.begin(), readings.end(),
                                   [&](const CuringReading& r) { return r.scatter > 0.75 * saturation; });
  if (below > 0 && above > 0) return;
  throw Error{Fault::data, "working curve: of " + std::to_string(readings.size()) + " readings " +
                               std::to_string(below) + " are below a quarter and " + std::to_string(above) +
                               " above three quarters of the saturation " + format_number(saturation, 3) +
                               "; give doses on either side of the threshold"};
}

struct Spread {
  bool several_turns = false;  // with light
  double most = 0;             // scatter
};

Spread spread_of(const std::vector<CuringReading>& readings, double lit_turns) {
  Spread spread;
  double first = lit_turns;
  double last = 0;
  for (const CuringReading& reading : readings) {
    if (reading.last_turn > 0) first = std::min(first, reading.last_turn);
    last = std::max(last, std::min(reading.last_turn, lit_turns));
    spread.most = std::max(spread.most, reading.scatter);
  }
  spread.several_turns = last > first;
  return spread;
}

CuringCurve curve_of(const std::vector<CuringReading>& readings, double lit_turns, std::optional<double> isovalue,
                     double inhibited_share) {
  const Spread spread = spread_of(readings, lit_turns);
  const std::vector<double> start = beginning(readings, lit_turns, spread.several_turns);
  std::vector<double> step{1e-4 * start[0], 1e-4 * start[1], 1e-4};
  if (spread.several_turns) step.push_back(1e-4);
  const stats::CurveFit fit = stats::fit_curve(
      [&](const std::vector<double>& parameters) {
        const Curve curve(parameters, inhibited_share);
        std::vector<double> residuals;
        for (const CuringReading& reading : readings) {
          residuals.push_back((reading.scatter - curve.density(reading, lit_turns)) /
                              std::hypot(reading.sigma, least_sigma * spread.most));
        }
        return residuals;
      },
      start, step, "working curve");
  const Curve curve(fit.value, inhibited_share);
  require_rise(readings, curve.saturation);
  CuringCurve result;
  result.isovalue = isovalue.value_or(0.5 * curve.saturation);
  if (!(result.isovalue < curve.saturation)) {
    throw Error{Fault::data, "working curve: the isovalue " + format_number(result.isovalue, 3) +
                                 " is not below the saturation " + format_number(curve.saturation, 3) +
                                 "; check --isovalue"};
  }
  const double ratio = std::log(result.isovalue / (curve.saturation - result.isovalue));
  const auto combined = [&](double value, double by_saturation, double by_middle, double by_log_width) {
    std::vector<double> weight(fit.value.size());
    weight[0] = by_saturation;
    weight[1] = by_middle;
    weight[2] = by_log_width;
    stats::Measured measured = fit.combined(weight);
    measured.value = value;
    return measured;
  };
  const double by_saturation = isovalue ? -curve.width / (curve.saturation - result.isovalue) : 0;
  result.critical_dose_mj_cm3 = combined(curve.middle + curve.width * ratio, by_saturation, 1, curve.width * ratio);
  result.induction_dose_mj_cm3 = combined(curve.middle - 2 * curve.width, 0, 1, -2 * curve.width);
  result.rate_per_mj_cm3 = combined(0.25 / curve.width, 0, 0, -0.25 / curve.width);
  result.saturation = fit.measured(0);
  if (spread.several_turns) result.delay_turns = fit.measured(3);
  result.rms = fit.rms;
  result.readings = fit.n;
  return result;
}

// Half of what a number differs by between two assumptions is one more standard deviation.
void widen(stats::Measured& number, const stats::Measured& one, const stats::Measured& other) {
  number.sigma = std::hypot(number.sigma, 0.5 * (one.value - other.value));
}

/// The curve; throws Fault::data where its critical dose is less certain than any use of it needs.
CuringCurve known(const CuringCurve& curve) {
  constexpr double most = 0.1;  // of the dose; good measurements have 0.02, and prints differ by 0.05
  const stats::Measured& dose = curve.critical_dose_mj_cm3;
  if (dose.sigma <= most * dose.value) return curve;
  throw Error{Fault::data, "working curve: the critical dose is not known, " + format_number(dose.value, 3) + " +- " +
                               format_number(dose.sigma, 3) +
                               " mJ/cm3; state which turns had light (--lit-from, --lit-turns), or give more volumes"};
}

double dose_at(const model::Volume& dose, const std::array<double, 3>& place) {
  return static_cast<double>(model::value_at(dose, place[0], place[1], place[2]));
}

// Where a neighbour has another dose, scatter is a mixture.
bool is_even(const model::Volume& dose, const std::array<double, 3>& place, double here, double voxel_mm,
             double most_change) {
  for (std::size_t a = 0; a < 3; ++a) {
    for (const double step_mm : {-voxel_mm, voxel_mm}) {
      std::array<double, 3> beside = place;
      beside[a] += step_mm;
      if (std::abs(dose_at(dose, beside) - here) >= most_change) return false;
    }
  }
  return true;
}

}  // namespace

std::vector<CuringReading> curing_readings(const model::Volume& scatter, const model::Volume& dose, double stretch_z,
                                           int classes, double first_turn, double last_turn) {
  const double most = static_cast<double>(*std::max_element(dose.values.begin(), dose.values.end()));
  const double wide = most / classes;
  std::vector<DoseClass> found(classes);
  const model::Grid& g = scatter.grid;
  for (int k = 0; k < g.nz; ++k) {
    for (int j = 0; j < g.ny; ++j) {
      for (int i = 0; i < g.nx; ++i) {
        const std::array<double, 3> place{g.x_mm(i), g.y_mm(j), g.z_mm(k) * stretch_z};
        const double here = dose_at(dose, place);
        if (!(here > least_share * most) || !is_even(dose, place, here, g.voxel_mm, 0.25 * wide)) continue;
        const double value = static_cast<double>(scatter.slice(k)[flat_index(j, g.nx, i)]);
        DoseClass& one = found[std::min(floor_int(here / wide), classes - 1)];
        one.dose += here;
        one.scatter += value;
        one.squares += value * value;
        one.voxels += 1;
      }
    }
  }
  std::vector<CuringReading> readings;
  for (const DoseClass& one : found) {
    if (one.voxels < together) continue;
    const double mean = one.scatter / one.voxels;
    const double spread = std::sqrt(std::max(0.0, one.squares / one.voxels - mean * mean));
    readings.push_back({one.dose / one.voxels, first_turn, last_turn, mean, spread / std::sqrt(one.voxels / together)});
  }
  return readings;
}

CuringCurve fit_curing_curve(const std::vector<CuringReading>& readings, double lit_turns,
                             std::optional<double> isovalue) {
  if (readings.empty()) throw Error{Fault::data, "working curve: no voxels of even dose; use a staircase of doses"};
  CuringCurve curve = curve_of(readings, lit_turns, isovalue, inhibited[0]);
  if (!curve.delay_turns) return known(curve);
  const CuringCurve low = curve_of(readings, lit_turns, isovalue, inhibited[1]);
  const CuringCurve high = curve_of(readings, lit_turns, isovalue, inhibited[2]);
  widen(curve.critical_dose_mj_cm3, low.critical_dose_mj_cm3, high.critical_dose_mj_cm3);
  widen(curve.induction_dose_mj_cm3, low.induction_dose_mj_cm3, high.induction_dose_mj_cm3);
  widen(curve.rate_per_mj_cm3, low.rate_per_mj_cm3, high.rate_per_mj_cm3);
  widen(curve.saturation, low.saturation, high.saturation);
  widen(*curve.delay_turns, *low.delay_turns, *high.delay_turns);
  return known(curve);
}

Json to_json(const CuringCurve& curve, double turn_s) {
  Json json{{"isovalue", curve.isovalue},
            {"critical_dose_mj_cm3", curve.critical_dose_mj_cm3.value},
            {"critical_dose_sigma_mj_cm3", curve.critical_dose_mj_cm3.sigma},
            {"induction_dose_mj_cm3", curve.induction_dose_mj_cm3.value},
            {"induction_dose_sigma_mj_cm3", curve.induction_dose_mj_cm3.sigma},
            {"rate_per_mj_cm3", curve.rate_per_mj_cm3.value},
            {"rate_sigma_per_mj_cm3", curve.rate_per_mj_cm3.sigma},
            {"saturation", curve.saturation.value},
            {"saturation_sigma", curve.saturation.sigma},
            {"rms_sigmas", curve.rms},
            {"readings", curve.readings}};
  if (curve.delay_turns && turn_s > 0) {
    json["delay_s"] = curve.delay_turns->value * turn_s;
    json["delay_sigma_s"] = curve.delay_turns->sigma * turn_s;
  }
  return json;
}

}  // namespace vam::metrology
