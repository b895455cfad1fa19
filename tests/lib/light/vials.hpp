// SPDX-License-Identifier: GPL-3.0-or-later
// Vials that the tests of light shine through.
#pragma once

#include <numbers>

#include "light/operators/private/vial_operator.hpp"
#include "optics/writable_radius.hpp"

namespace parts {

inline const vam::optics::View plain_vial{119.808, 1.0, 0.0, {{12.7, 1.53}}};            // [RAY21]
inline const vam::optics::View walled_vial{60, 1.0, 0.0, {{12.7, 1.47}, {11.5, 1.51}}};  // a glass wall, a short throw

/// The writable circle in `size` voxels, before 440 columns of 0.065 mm.
inline vam::light::VialSetup vial_setup(int size, int angles, const vam::optics::View& view = plain_vial) {
  vam::light::VialSetup setup;
  setup.view = view;
  setup.projector = vam::optics::centred_detector(440, 0.065);
  setup.turn = {angles, 0, 2 * std::numbers::pi / angles};
  setup.radius_mm = vam::optics::reach_mm(view);
  setup.grid = vam::model::centred_grid(size, size, 1, 2 * setup.radius_mm / size);
  return setup;
}

}  // namespace parts
