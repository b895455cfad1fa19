// SPDX-License-Identifier: GPL-3.0-or-later
// The sensitivity of a print, on densities that follow from a known one.
#include "metrology/cure/sensitivity.hpp"

#include "base/text/json.hpp"
#include "testing.hpp"

using namespace vam;
using namespace vam::metrology;

namespace {

ScatterCurve resin_curve() {
  return scatter_curve(
      {{"isovalue", 0.04}, {"saturation", 0.08}, {"critical_dose_mj_cm3", 60}, {"rate_per_mj_cm3", 0.07}});
}

/// Ripples about the critical dose, as late in a print; moved along x.
double ripple(double x_mm, double y_mm, double z_mm, double aside_mm) {
  if (std::hypot(x_mm, y_mm) > 3.5) return 0;
  return 60 + 18 * std::sin(2 * (x_mm - aside_mm)) * std::cos(1.7 * y_mm) * std::sin(1.5 * z_mm);
}

model::Volume ripples(double aside_mm) {
  model::Volume dose{model::centred_grid(40, 40, 30, 0.2, -2.9), {}};
  const model::Grid& g = dose.grid;
  for (const auto [k, j, i] : indices(g.nz, g.ny, g.nx)) {
    dose.values.push_back(static_cast<float>(ripple(g.x_mm(i), g.y_mm(j), g.z_mm(k), aside_mm)));
  }
  return dose;
}

/// What the views of that resin would show, in the print's own heights.
model::Volume densities(double aside_mm, const SensitivityField& truth, double stretch_z, double noise) {
  model::Volume scatter{model::centred_grid(36, 36, 28, 0.2, -2.7), {}};
  const model::Grid& g = scatter.grid;
  const ScatterCurve curve = resin_curve();
  std::mt19937_64 random(7);
  std::normal_distribution<double> normal(0, noise);
  for (const auto [k, j, i] : indices(g.nz, g.ny, g.nx)) {
    const double z = g.z_mm(k) * stretch_z;
    const double dose = ripple(g.x_mm(i), g.y_mm(j), z, aside_mm);
    const double acts = dose * std::exp(truth.log_at(g.x_mm(i), g.y_mm(j), z));
    scatter.values.push_back(static_cast<float>(curve.saturation * (curve.density(acts) + normal(random))));
  }
  return scatter;
}

SensitivityField some_truth(const SensitivityField& box) {
  SensitivityField truth = box;
  truth.value = {-0.1, 0.01, -0.02, 0.04, 0.03, 0.01, -0.02, 0.01, 0, 0.01};
  return truth;
}

}  // namespace

TEST_CASE("A record of a working curve is the logistic curve that it was fitted with") {
  const ScatterCurve curve = resin_curve();
  CHECK(curve.middle_mj_cm3 == doctest::Approx(60));
  CHECK(curve.density(60) == doctest::Approx(0.5));
  CHECK(curve.density(60 + 0.25 / 0.07) == doctest::Approx(1 / (1 + std::exp(-1))));
  CHECK(curve.delay_s == 0);
  // At an isovalue of a quarter of the saturation the dose is w ln 3 below the middle.
  const ScatterCurve low = scatter_curve({{"isovalue", 0.02},
                                          {"saturation", 0.08},
                                          {"critical_dose_mj_cm3", 60},
                                          {"rate_per_mj_cm3", 0.07},
                                          {"delay_s", 4}});
  CHECK(low.middle_mj_cm3 == doctest::Approx(60 + 0.25 / 0.07 * std::log(3)));
  CHECK(low.delay_s == 4);
  CHECK(fault_of([] { (void)scatter_curve({{"saturation", 0.08}}); }) == Fault::data);
  CHECK(fault_of([] {
          (void)scatter_curve(
              {{"isovalue", 0.09}, {"saturation", 0.08}, {"critical_dose_mj_cm3", 60}, {"rate_per_mj_cm3", 1}});
        }) == Fault::data);
}

TEST_CASE("The sensitivity that made the densities of a turn is found, within its deviation") {
  const ScatterCurve curve = resin_curve();
  const PlannedDose dose{{ripples(0)}};
  const SensitivityField before = expected_sensitivity(dose.middle(), curve, {});
  const SensitivityField truth = some_truth(before);
  const model::Volume scatter = densities(0, truth, 1, 0.02);
  const SensitivityFit fit = fit_sensitivity(scatter, nullptr, {dose}, curve, before, 0);
  int within = 0;
  for (const double x : {-2.0, 0.0, 2.0}) {
    for (const double z : {-2.0, 0.0, 2.0}) {
      const double off = fit.field.log_at(x, 0.5, z) - truth.log_at(x, 0.5, z);
      CHECK(std::abs(off) < 0.01);
      within += std::abs(off) < 2 * fit.field.sigma_at(x, 0.5, z) ? 1 : 0;
    }
  }
  CHECK(within >= 8);  // of nine
  CHECK(fit.rms < 1);  // noise of 2 % where 3 % are expected
  CHECK(fit.explained < 0.3);
  CHECK(fit.field.axis_px == 0);
  const SensitivityRange range = range_of(fit.field, dose.middle(), 60);
  CHECK(range.low < range.mean);
  CHECK(range.mean < range.high);
  CHECK(range.mean == doctest::Approx(std::exp(-0.1)).epsilon(0.03));
  const SensitivityRange expected = range_of(before, dose.middle(), 60);
  CHECK(doubts(fit, range, expected, {}).empty());
  // What was known before counts: of a second turn's densities the deviation is smaller.
  const SensitivityFit again = fit_sensitivity(scatter, nullptr, {dose}, curve, carried_on(fit.field, {}), 0);
  CHECK(range_of(again.field, dose.middle(), 60).sigma < range.sigma);
  CHECK(doubts(again, range_of(again.field, dose.middle(), 60), range, {}).empty());
  // Densities of the past: those of a dose that is 15 % smaller.
  PlannedDose later = dose;
  for (float& value : later.at[0].values) value *= 1.15F;
  const SensitivityFit past = fit_sensitivity(scatter, nullptr, {later}, curve, carried_on(fit.field, {}), 0);
  const auto changed = doubts(past, range_of(past.field, dose.middle(), 60), range, {});
  REQUIRE(changed.size() == 1);
  CHECK(has(changed.front(), " was expected, a difference of more than"));
}

TEST_CASE("Densities are of the print's heights, doses of the stretched ones") {
  const ScatterCurve curve = resin_curve();
  const PlannedDose dose{{ripples(0)}};
  const SensitivityField before = expected_sensitivity(dose.middle(), curve, {});
  const model::Volume scatter = densities(0, some_truth(before), 1.05, 0);
  const SensitivityFit right = fit_sensitivity(scatter, nullptr, {dose, 1.05}, curve, before, 0);
  const SensitivityFit wrong = fit_sensitivity(scatter, nullptr, {dose, 1}, curve, before, 0);
  CHECK(right.rms < 0.5 * wrong.rms);
}

TEST_CASE("The axis is found by the doses with the axis to either side, on its side") {
  const ScatterCurve curve = resin_curve();
  constexpr double px_mm = 0.05;
  const PlannedDose dose{{ripples(-2 * px_mm), ripples(0), ripples(2 * px_mm)}, 2};
  const SensitivityField before = expected_sensitivity(dose.middle(), curve, SensitivityPrior{.axis_px = 1});
  CHECK(before.axis_sigma_px() == doctest::Approx(1));
  for (const double px : {-1.5, 0.0, 1.0}) {
    CAPTURE(px);
    const SensitivityFit fit =
        fit_sensitivity(densities(px * px_mm, some_truth(before), 1, 0.02), nullptr, {dose}, curve, before, 0);
    CHECK(std::abs(fit.field.axis_px - px) < 0.05);  // the parabola through ripples
    CHECK(fit.field.axis_sigma_px() < 0.05);
  }
  CHECK(dose.with(2).values == dose.at[2].values);
  CHECK(dose.with(0).values == dose.at[1].values);
  // Closer together, about another place, the parabola is that of the ripples.
  const PlannedDose near{{ripples(0.5 * px_mm), ripples(px_mm), ripples(1.5 * px_mm)}, 0.5, 1};
  const SensitivityFit fit =
      fit_sensitivity(densities(1.2 * px_mm, some_truth(before), 1, 0.02), nullptr, {near}, curve, before, 0);
  CHECK(std::abs(fit.field.axis_px - 1.2) < 2 * fit.field.axis_sigma_px());
  CHECK(near.with(1).values == near.at[1].values);
}

TEST_CASE("Before anything scatters, and where nothing fits, there is doubt") {
  const ScatterCurve curve = resin_curve();
  const PlannedDose dose{{ripples(0)}};
  const SensitivityField before = expected_sensitivity(dose.middle(), curve, {});
  model::Volume nothing{model::centred_grid(36, 36, 28, 0.2, -2.7), {}};
  nothing.values.resize(nothing.grid.size());
  PlannedDose early = dose;
  for (float& value : early.at[0].values) value *= 0.6F;
  const SensitivityFit dark = fit_sensitivity(nothing, nullptr, {early}, curve, before, 0);
  const SensitivityRange expected = range_of(before, dose.middle(), 60);
  const auto unsure = doubts(dark, range_of(dark.field, dose.middle(), 60), expected, {});
  REQUIRE(unsure.size() == 1);
  CHECK(has(unsure.front(), "is known to"));

  model::Volume noise = nothing;
  std::mt19937_64 random(3);
  for (float& value : noise.values) value = std::uniform_real_distribution<float>(0, 0.08F)(random);
  const SensitivityFit wild = fit_sensitivity(noise, nullptr, {dose}, curve, before, 0);
  CHECK_FALSE(doubts(wild, range_of(wild.field, dose.middle(), 60), expected, {}).empty());

  SensitivityField much = before;
  much.value[0] = 0.6;
  CHECK_FALSE(doubts({much, 0, 0, 0}, range_of(much, dose.middle(), 60), expected, {1, 0.5, 3, 1}).empty());

  for (float& value : early.at[0].values) value *= 0.1F;
  CHECK(fault_of([&] { (void)expected_sensitivity(early.at[0], curve, {}); }) == Fault::data);
  CHECK(fault_of([&] { (void)fit_sensitivity(nothing, nullptr, {early}, curve, before, 0); }) == Fault::data);
}

TEST_CASE("A delivered dose that planned light completes to the critical one is one that acts as it") {
  const ScatterCurve curve = resin_curve();
  const model::Volume dose = ripples(0);
  SensitivityField field = some_truth(expected_sensitivity(dose, curve, {}));
  const model::Volume delivered = delivered_dose(dose, field, 60);
  const model::Grid& g = dose.grid;
  const std::size_t v = 14 * g.slice_size() + 20 * g.nx + 12;
  const double s = std::exp(field.log_at(g.x_mm(12), g.y_mm(20), g.z_mm(14)));
  const double rest = 60 - static_cast<double>(delivered.values[v]);
  CHECK(s * (static_cast<double>(dose.values[v]) + rest) == doctest::Approx(60).epsilon(1e-6));
  CHECK(delivered.values.front() == 0);  // nothing was given there, and less than that is none
  const SensitivityField copy = sensitivity_field(Json::parse(to_json(field).dump()));
  CHECK(copy.value == field.value);
  CHECK(copy.covariance == field.covariance);
  CHECK(fault_of([] { (void)sensitivity_field({{"centre_mm", 3}}); }) == Fault::data);
  Json none = to_json(field);
  for (auto& value : none["covariance"]) value = 0;
  CHECK(fault_of([&] { (void)sensitivity_field(none); }) == Fault::data);
  none = to_json(field);
  none["half_mm"][1] = 0;
  CHECK(fault_of([&] { (void)sensitivity_field(none); }) == Fault::data);
  const double nan = std::nan("");
  CHECK(doubts({field, nan, 0, 0}, {nan, nan, nan, nan}, {}, {}).size() == 4);
}
