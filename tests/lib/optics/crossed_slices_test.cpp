// SPDX-License-Identifier: GPL-3.0-or-later
// How many slices the light of one row crosses.
#include "optics/ray_list.hpp"
#include "testing.hpp"

using namespace vam;
using optics::crossed_slices;

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
