// SPDX-License-Identifier: GPL-3.0-or-later
// All that may be asked and ordered of a stage.
#pragma once

#include "base/text/json.hpp"
#include "device/stage/stage.hpp"
#include "fuzz/fuzz.hpp"

namespace fuzz {

inline void drive(vam::device::Stage& stage) {
  attempt([&] { (void)stage.identify().dump(); });
  attempt([&] { (void)stage.caps(); });
  attempt([&] { stage.enable(); });
  attempt([&] { stage.start_homing(); });
  attempt([&] { (void)stage.homed(); });
  attempt([&] { stage.set_speed(10); });
  attempt([&] { stage.set_angle(5); });
  attempt([&] { stage.start_move(720); });
  attempt([&] { (void)stage.sample(); });
  attempt([&] { (void)stage.moving(); });
  attempt([&] { (void)stage.fault(); });
  attempt([&] { stage.stop(vam::device::Stop::smooth); });
}

}  // namespace fuzz
