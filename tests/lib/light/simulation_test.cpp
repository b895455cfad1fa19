// SPDX-License-Identifier: GPL-3.0-or-later
#include "light/simulation/simulation.hpp"

#include "base/text/json.hpp"
#include "light/grids/dose_grid.hpp"
#include "light/grids/lit_grid.hpp"
#include "light/simulation/display_range.hpp"
#include "model/magnification.hpp"
#include "optics/writable_radius.hpp"
#include "resin/absolute_dose.hpp"
#include "score/exposure.hpp"
#include "testing.hpp"

using namespace vam;
using namespace vam::score;
using namespace vam::light;

namespace {

constexpr double turn_rad = 2 * std::numbers::pi;

model::StackInfo stack(model::Space space, int columns, double pixel_mm, int count = 1) {
  model::StackInfo info;
  info.space = space;
  info.width = columns;
  info.height = 180;
  info.count = count;
  info.pixel_mm = info.row_mm = pixel_mm;
  info.angle_step_deg = 2;
  return info;
}

model::Printer small_printer() {
  return {.projector = {.columns = 200, .pixel_mm = 0.15, .lens_distance_mm = 120, .axis_column = 99.5},
          .stage = {.motion = "stepped"}};
}

}  // namespace

TEST_CASE("parallel light that absorption weakens: the mean of e^{-mu s} over all directions") {
  model::Printer printer = small_printer();
  printer.resin.absorption_per_mm = 0.08;
  const model::StackInfo info = stack(model::Space::virtual_, 200, 0.15);
  const model::Grid grid = dose_grid(printer, info, 28.0);
  CHECK(grid.nx == 187);
  const Simulation simulation(printer, {}, info, grid);
  const std::vector<Image> in(1, Image(200, 180, 1.0F));
  std::vector<Image> out(1);
  simulation.dose(in, out);
  for (const int i : {93, 110, 130, 160}) {
    const double r = std::hypot(grid.x_mm(i), grid.y_mm(80));
    double want = 0;
    for (int k = 0; k < 2000; ++k) {
      const double b = turn_rad * k / 2000;
      const double t = r * std::cos(b);
      want += std::exp(-0.08 * (std::sqrt(12.7 * 12.7 - t * t) + r * std::sin(b))) * turn_rad / 2000;
    }
    CHECK(std::abs(out[0](i, 80) / want - 1) < 1e-3);  // pixels of 0.15 mm, angles of 2 deg: (mu h)^2 and (r dtheta)^2
  }
  CHECK(out[0](0, 0) == 0);  // beside the resin
}

TEST_CASE("a projector's stack is traced, with the printer's own columns") {
  const model::Printer printer = small_printer();
  const model::StackInfo info = stack(model::Space::projector, 200, 0.15);
  const model::Grid grid = dose_grid(printer, info, std::nullopt);
  CHECK(grid.nx == static_cast<int>(std::ceil(2 * 12.7 / 1.53 / 0.15)));
  const std::vector<Image> in(1, Image(200, 180, 1.0F));
  std::vector<Image> out(1);
  Simulation(printer, {}, info, grid).dose(in, out);
  // On the axis: 2 pi T / J, and the rows' convergence.
  const optics::ChiefRay ray = optics::chief_ray(optics::projector_view(printer), 0);
  const int middle = grid.nx / 2;
  CHECK(out[0](middle, middle) ==
        doctest::Approx(turn_rad * ray.transmittance / ray.jacobian / model::vertical_magnification(printer))
            .epsilon(1e-3));
  CHECK_THROWS_AS(Simulation(printer, {}, stack(model::Space::projector, 199, 0.15), grid), Error);
  CHECK_THROWS_AS(Simulation(printer, {}, stack(model::Space::projector, 200, 0.16), grid), Error);
  CHECK_THROWS_AS(Simulation(printer, {}, stack(model::Space::camera, 200, 0.15), grid), Error);
}

TEST_CASE("rays stay horizontal where rows are telecentric") {
  model::Printer printer = small_printer();
  printer.projector.lens_distance_mm = 40;
  model::StackInfo info = stack(model::Space::projector, 200, 0.15, 9);
  info.z_start_mm = 6;
  const model::Grid grid = model::centred_grid(20, 20, 9, 0.15, info.z_start_mm);
  std::vector<Image> rows(9, Image(200, 180));
  rows[4].values.assign(rows[4].size(), 1.0F);
  const auto elsewhere = [&] {  // share of the middle row's light that is in other slices than its own
    std::vector<Image> doses(9);
    Simulation(printer, {}, info, grid).dose(rows, doses);
    double own = 0, others = 0;
    for (std::size_t k = 0; k < doses.size(); ++k) {
      for (const float dose : doses[k].values) (k == 4 ? own : others) += static_cast<double>(dose);
    }
    CHECK(own > 0);
    return others / (own + others);
  };
  CHECK(elsewhere() > 0.1);
  printer.projector.telecentric_columns = true;
  CHECK(elsewhere() > 0.1);
  CHECK(lit_margin(printer, grid, optics::writable_radius_mm(printer)).above > 0);
  printer.projector.telecentric_columns = false;
  printer.projector.telecentric_rows = true;
  CHECK(elsewhere() == 0);
  CHECK(lit_margin(printer, grid, optics::writable_radius_mm(printer)).above == 0);
}

TEST_CASE("grids: cubes, and slices that are slices of the volume") {
  const model::Printer printer = small_printer();
  model::StackInfo info = stack(model::Space::virtual_, 64, 0.2, 10);
  info.z_start_mm = -1;
  const model::Grid grid = dose_grid(printer, info, std::nullopt);
  CHECK(grid == model::centred_grid(64, 64, 10, 0.2, -1));
  CHECK(first_slice(grid, info) == 0);
  model::Grid taller = model::centred_grid(64, 64, 30, 0.2, -2);
  CHECK(first_slice(taller, info) == 5);
  taller.origin_mm[2] += 0.05;
  CHECK_THROWS_AS(static_cast<void>(first_slice(taller, info)), Error);
  CHECK_THROWS_AS(static_cast<void>(first_slice(model::centred_grid(64, 64, 9, 0.2, -1), info)), Error);
  CHECK_THROWS_AS(static_cast<void>(first_slice(model::centred_grid(64, 64, 40, 0.1, -1), info)), Error);
  info.row_mm = 0.3;
  CHECK_THROWS_AS(static_cast<void>(dose_grid(printer, info, std::nullopt)), Error);
}

TEST_CASE("sinogram values become intensity") {
  std::vector<Image> values(1, Image(4, 1));
  values[0].values = {-1, 0.5F, 2, 4};
  std::vector<Image> light = values;
  LightSeen seen;
  shine({true, {}, 0.1}, light, seen);
  CHECK(light[0].values == std::vector<float>{0, 0.5F, 2, 4});
  CHECK(seen.peak == 4);
  CHECK(seen.least == -1);
  CHECK(seen.negative == 1);
  light = values;
  shine({true, 2.0, 0.1}, light, seen);
  CHECK(light[0].values == std::vector<float>{0.1F, 0.25F, 1, 1});
  light = values;
  shine({false, {}, 0.0}, light, seen);
  CHECK(light[0].values == values[0].values);
}

TEST_CASE("absolute dose: mu / Omega times the light of one turn [CAL19 eq 1]") {
  model::Printer printer;
  CHECK_FALSE(resin::dose_per_radian_mj_cm3(printer).has_value());
  printer.resin.critical_dose_mj_cm3 = 100;
  CHECK_FALSE(resin::dose_per_radian_mj_cm3(printer).has_value());  // resin that absorbs nothing takes no dose
  printer.resin.absorption_per_mm = 0.05;
  // A point in even light of 3.8 mW/cm2 for the 36 s of a turn takes 3.8 * 36 * 0.5/cm = 68.4 mJ/cm3.
  REQUIRE(resin::dose_per_radian_mj_cm3(printer).has_value());
  CHECK(*resin::dose_per_radian_mj_cm3(printer) * turn_rad == doctest::Approx(68.4));
}

TEST_CASE("turns and seconds to the critical dose") {
  model::Printer printer{.resin = {.absorption_per_mm = 0.05, .critical_dose_mj_cm3 = 100}};
  Image dose(3, 1);
  dose.values = {1, 2, 4};
  Image target(3, 1);
  target.values = {0, 1, 1};
  TurnDoses range;
  range.add(dose, target);
  Json json = range.doses("per_turn", true, 10);
  json.update(range.exposures(printer, 10));
  CHECK(json["part_dose_per_turn_min_mj_cm3"] == 20);
  CHECK(json["part_dose_per_turn_mean_mj_cm3"] == 30);
  CHECK(json["turns_to_critical_mean"] == 4);
  CHECK(json["turns_to_critical_all"] == 5);
  CHECK(json["duration_to_critical_all_s"] == 5 * 36);
  CHECK(json["dose_per_turn_max_mj_cm3"] == 40);
  CHECK_THROWS_AS(range.add(dose, Image(2, 1)), Error);
  TurnDoses dark;
  dark.add(Image(3, 1), {});
  CHECK(dark.exposures(printer, 10)["turns_to_critical_max"].is_null());
}
