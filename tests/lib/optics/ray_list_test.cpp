// SPDX-License-Identifier: GPL-3.0-or-later
// The rays of one row as CSV.
#include "optics/ray_list.hpp"

#include <sstream>

#include "optics/resample_stack.hpp"
#include "testing.hpp"

using namespace vam;

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
