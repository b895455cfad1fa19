// SPDX-License-Identifier: GPL-3.0-or-later
// A small vial, projector and camera, in which tests cure resin.
#pragma once

#include "model/printer.hpp"

namespace vam::test {

/// Rows, intensity, absorption and critical dose are the test's own.
inline vam::model::Printer curing_printer() {
  vam::model::Printer printer;
  printer.projector.columns = 64;
  printer.projector.pixel_mm = 0.2;
  printer.projector.lens_distance_mm = 90;
  printer.projector.axis_column = 31.5;
  printer.vial = {6, 0.5, 1.52};
  printer.resin.index = 1.49;
  printer.camera.index_resin = 1.48;
  printer.stage.speed_deg_s = 30;
  return printer;
}

}  // namespace vam::test
