// SPDX-License-Identifier: GPL-3.0-or-later
#include "light/simulation/simulation.hpp"
#include "resin/absolute_dose.hpp"
#include "score/exposure.hpp"
#include "testing.hpp"
#include "verdict/verdict.hpp"

using namespace vam;
using namespace vam::score;
using namespace vam::verdict;
using namespace vam::light;

namespace {

model::Printer printer_of(double absorption_per_mm, double critical) {
  model::Printer printer{.projector = {.columns = 200, .pixel_mm = 0.15, .telecentric = true, .axis_column = 99.5}};
  printer.bath.index = 1.53;  // that of the resin: rays go straight through
  printer.bath.window_mm = 20;
  printer.resin.absorption_per_mm = absorption_per_mm;
  printer.resin.critical_dose_mj_cm3 = critical;
  return printer;
}

/// The plan for a rod of 1 mm on the axis in even light: simulated by chief rays, judged against the part, planned.
ExposurePlan rod(const model::Printer& printer) {
  model::StackInfo info;
  info.space = model::Space::projector;
  info.width = printer.projector.columns;
  info.pixel_mm = info.row_mm = printer.projector.pixel_mm;
  info.height = 180;
  info.angle_step_deg = 2;
  info.count = 1;
  const model::Grid grid = model::centred_grid(21, 21, 1, 0.15);
  const std::vector<Image> light(1, Image(info.width, info.height, 1.0F));
  std::vector<Image> dose(1);
  Simulation(printer, {}, info, grid).dose(light, dose);
  model::DoseStatistics statistics;
  for (const auto [y, x] : indices(21, 21)) {
    statistics.add(dose[0](x, y), std::hypot(x - 10, y - 10) < 3 ? model::Label::part : model::Label::void_);
  }
  return plan_exposure(statistics.metrics(false), *resin::dose_per_radian_mj_cm3(printer), printer);
}

model::DoseMetrics window(double low, double high) {
  return {.min_part = high, .max_void = low, .iou_threshold = 0.5 * (low + high)};
}

// Without a window: the critical dose is reached at that dose alone.
ExposurePlan plan_at(double dose, const model::Printer& printer) {
  return plan_exposure(window(dose, dose), 1, printer);
}

}  // namespace

TEST_CASE("full light for fewer turns will do where the critical dose is still in the middle half of the window") {
  const model::Printer printer = printer_of(0.05, 100);
  const ExposurePlan two = plan_exposure(window(44, 54), 1, printer);  // 100 is within 2 x (46.5 ... 51.5)
  CHECK(two.turns == 2);
  CHECK(two.multiplier == 1);
  const ExposurePlan helix = plan_exposure(window(44, 54), 1, printer, 3);  // frames of three turns, twice
  CHECK(helix.turns == 3 * two.turns);
  CHECK(helix.multiplier == two.multiplier);
  CHECK(helix.seconds == doctest::Approx(3 * two.seconds));
  const ExposurePlan three = plan_exposure(window(4.2, 5.2), 10, printer);  // 100 is beyond 2 x (44.5 ... 49.5)
  CHECK(three.turns == 3);
  CHECK(three.multiplier == doctest::Approx(100 / (3 * 47.0)));
}

TEST_CASE("the fewest whole turns, and the intensity that makes them exact") {
  const model::Printer printer = printer_of(0.05, 100);
  const ExposurePlan plan = plan_at(30, printer);
  CHECK(plan.turns == 4);
  CHECK(plan.multiplier * plan.turns * 30 == doctest::Approx(100));
  CHECK(plan.seconds == doctest::Approx(144));
  CHECK(plan.peak_intensity_mw_cm2 == doctest::Approx(3.8 * 100 / 120));
  CHECK(plan_at(25, printer).turns == 4);
  CHECK(plan_at(25, printer).multiplier == 1.0);
  CHECK(plan_at(400, printer).turns == 1);
  CHECK(plan_at(400, printer).multiplier == doctest::Approx(0.25));
  CHECK(fault_of([&] { static_cast<void>(plan_at(0, printer)); }) == Fault::data);
  CHECK(fault_of([&] { static_cast<void>(plan_at(1e-9, printer)); }) == Fault::data);
}

TEST_CASE("the middle of the window, or of the best thresholds where there is none") {
  model::DoseMetrics doses{.min_part = 8, .max_void = 5, .iou_threshold = 6.7};
  CHECK(window_middle(doses) == 6.5);
  doses.max_void = 9;
  CHECK(window_middle(doses) == 6.7);
}

TEST_CASE("the aim is the threshold of the light within the middle half of the window, else its middle") {
  model::DoseMetrics doses{.min_part = 9, .max_void = 5};
  CHECK(aimed_dose(doses, std::nullopt) == 7);
  CHECK(aimed_dose(doses, 6.1) == 6.1);
  CHECK(aimed_dose(doses, 7.9) == 7.9);
  CHECK(aimed_dose(doses, 5.9) == 7);
  CHECK(aimed_dose(doses, 8.1) == 7);
  doses.max_void = 10;  // no window
  doses.iou_threshold = 9.5;
  CHECK(aimed_dose(doses, 9.6) == 9.5);
}

TEST_CASE("a print puts the critical dose on the threshold of its light") {
  model::Printer printer;
  printer.resin.critical_dose_mj_cm3 = 100;
  CHECK(plan_exposure(window(160, 240), 1, printer, 1, 190).multiplier == doctest::Approx(100.0 / 190));
  CHECK(plan_exposure(window(160, 240), 1, printer, 1, 230).multiplier == doctest::Approx(100.0 / 200));
}

TEST_CASE("at given power the print is shortest where light falls to 1/e over the radius [CAL19]") {
  // On the axis a turn gives mu e^{-mu R}: from 0.7 to 1.3 it varies by 5 %, next to the optimum by 0.5 %; thousands of
  // turns resolve that.
  const double radius_mm = 12.7;
  std::vector<double> seconds;
  for (int tenths = 3; tenths <= 25; ++tenths)
    seconds.push_back(rod(printer_of(0.1 * tenths / radius_mm, 1e5)).seconds);
  const auto best = std::min_element(seconds.begin(), seconds.end());
  CHECK(best - seconds.begin() + 3 == 10);
  for (auto at = seconds.begin(); at != best; ++at) CHECK(at[0] > at[1]);  // falls towards it
  for (auto at = best; at + 1 != seconds.end(); ++at) CHECK(at[0] < at[1]);
  CHECK(seconds.front() / *best == doctest::Approx(std::exp(0.3 - 1) / 0.3).epsilon(0.01));
}
