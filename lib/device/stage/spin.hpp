// SPDX-License-Identifier: GPL-3.0-or-later
// What vam-stage does with a stage; first of all the motion of a print: ramp, run-up, whole turns, stop.
#pragma once

#include <functional>
#include <optional>

#include "device/os/angle_sample.hpp"
#include "device/stage/stage.hpp"

namespace vam::device {

/// A stage that moves is queried at least this often: a good answer reports to the guardian that all is well.
constexpr double heartbeat_s = 0.1;

/// So long a stage may take to stop that an earlier command has left braking; until then it accepts no order.
constexpr double braking_s = 10;

struct SpinPlan {
  double speed_deg_s = 10;
  int turns = 1;                  // of printing
  double run_up_turns = 1;        // at constant speed, before angle 0
  int direction = 1;              // +1 or -1: the sign of the controller's angle
  double period_s = 0.01;         // of the samples reported
  double speed_tolerance = 0.01;  // of the speed reached before angle 0; a slower or faster stage is refused
};

/// The motion of a spin, in the angles that it reports.
struct SpinCourse {
  double start_deg = 0;  // negative: ramp and run-up
  double end_deg = 0;    // of the order that is given; the stage is stopped before it gets there
  double min_deg = 0;    // of the controller's travel, turned round for direction -1
  double max_deg = 0;
  double seconds = 0;  // until the stage stands again
};

/// What spin() would do now, or after the reference was found, without motion. Throws as spin() does before it moves.
[[nodiscard]] SpinCourse plan_spin(Stage& stage, const SpinPlan& plan, bool after_homing);

/// Turns the stage and reports its angle. Angles count from 0 where printing begins: negative during ramp and run-up,
/// past 360 * turns when it ends. Angle 0 is the stage's own zero (its reference after homing), whatever the number of
/// runs before. One long motion, inside the controller's limits, re-zeroed before each run.
/// Throws Fault::data (limits too narrow for so many turns, or a stage that is not referenced), Fault::protocol (speed
/// off by more than the tolerance shortly before angle 0, or a stage that does not follow its own line), and what the
/// stage throws. Stops the stage whenever it leaves.
void spin(Stage& stage, Clock& clock, const SpinPlan& plan, const std::function<void(const AngleSample&)>& report);

/// Waits until the stage stands, sampling every period_s. Throws Fault::busy after timeout_s.
void wait_until_standing(Stage& stage, Clock& clock, double period_s, double timeout_s,
                         const std::function<void(const AngleSample&)>& report = {});

/// Turns to an absolute angle, or by an angle, and waits until the stage stands there. Throws Fault::data when an
/// absolute angle is commanded of a stage that is not referenced, or one beyond its travel; Fault::protocol when it
/// stands elsewhere.
void move(Stage& stage, Clock& clock, double angle_deg, bool relative, double speed_deg_s, double timeout_s);

/// Stops the stage and waits until it stands.
void halt(Stage& stage, Clock& clock, Stop how);

/// Reports the angle every period_s, for `seconds` or until a signal, and moves nothing.
void follow(Stage& stage, Clock& clock, double period_s, std::optional<double> seconds,
            const std::function<void(const AngleSample&)>& report);

/// Throws Fault::data when the stage is not referenced.
void require_referenced(Stage& stage);

/// Throws Fault::data when the stage reports a lower largest speed.
void require_speed_in_range(Stage& stage, double speed_deg_s);

/// identify() and caps() in one.
[[nodiscard]] Json describe(Stage& stage);

/// Angle, motion and pending error.
[[nodiscard]] Json status(Stage& stage);

/// Powers the motor, searches the reference and waits. Throws Fault::busy after timeout_s.
void home(Stage& stage, Clock& clock, double timeout_s);

}  // namespace vam::device
