// SPDX-License-Identifier: GPL-3.0-or-later
// The rays of one row as CSV, and how many slices its light crosses.
#include "optics/ray_list.hpp"

#include <sstream>

#include "optics/resample_stack.hpp"
#include "testing.hpp"

using namespace vam;
using optics::crossed_slices;

TEST_CASE("the rays of the middle row are those of the map") {
  model::Printer printer{
      .projector = {.columns = 3, .pixel_mm = 2, .lens_distance_mm = 120, .axis_column = 1, .axis_row = 383}};
  std::ostringstream level;
  optics::write_rays(level, printer, optics::projector_detector(printer, {}), 383);
  const auto ray = optics::chief_ray(optics::projector_view(printer), 2);
  std::ostringstream want;
  want.precision(10);
  want << "column,row,x_p_mm,z_p_mm,x_v_mm,z_mm,climb,delta_deg,T\n0,383,-2,0,";
  CHECK(level.str().find(want.str()) == 0);
  want.str("");
  want << "\n2,383,2,0," << ray.x_v_mm << ",0,0,";
  CHECK(has(level.str(), want.str()));
  printer.vial.radius_mm = 1.5;  // the outer columns pass beside it
  std::ostringstream beside;
  optics::write_rays(beside, printer, optics::projector_detector(printer, {}), 373);
  CHECK(has(beside.str(), "\n2,373,2,20,,,,,\n"));
}

namespace {

model::StackInfo stack(int count, double pitch_mm) {
  model::StackInfo info;
  info.count = count;
  info.row_mm = info.pixel_mm = pitch_mm;
  info.z_start_mm = -0.5 * (count - 1) * pitch_mm;
  return info;
}

}  // namespace

TEST_CASE("low rays leave their slice by z R_w / (D n M_vp) and a little more the higher they are") {
  const model::Printer printer;
  const double distance_mm = 1.8 * 1024 * 0.065;
  const double shrunk = 1 - 12.7 * (1 - 1 / 1.53) / distance_mm;
  const double radius_mm = 12.7 / 1.53;
  // Behind the surface of index n a low ray climbs z_p / (D n) a length.
  const double low = 0.05 * radius_mm / (distance_mm * 1.53 * shrunk) / 0.1;
  CHECK(crossed_slices(printer, stack(2, 0.1)) == doctest::Approx(low).epsilon(1e-4));
  CHECK(crossed_slices(printer, stack(101, 0.1)) == doctest::Approx(100 * low).epsilon(2e-3));
  CHECK(crossed_slices(printer, stack(1, 0.1)) == 0);
  // Slices beyond the projector's rows have no light that could leave them.
  CHECK(crossed_slices(printer, stack(9001, 0.1)) < 500 * low * 1.05);
}

TEST_CASE("level rays stay in their slice") {
  model::Printer printer;
  printer.projector.telecentric_rows = true;
  CHECK(crossed_slices(printer, stack(400, 0.1)) == 0);
}
