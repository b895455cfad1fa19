// SPDX-License-Identifier: GPL-3.0-or-later
// The short commands: home, move, stop, follow, identify, status.
#include <algorithm>
#include <cmath>
#include <optional>

#include "base/error.hpp"
#include "base/text/json.hpp"
#include "base/text/text.hpp"
#include "device/os/identity.hpp"
#include "device/stage/private/ripple_filter.hpp"
#include "device/stage/private/stop_on_exit.hpp"
#include "device/stage/spin.hpp"

namespace vam::device {

void wait_until_standing(Stage& stage, Clock& clock, double period_s, double timeout_s,
                         const std::function<void(const AngleSample&)>& report) {
  const double deadline_s = clock.now_s() + timeout_s;
  while (stage.moving()) {
    if (clock.now_s() > deadline_s) {
      throw Error{Fault::busy, "stage: still moving after " + format_number(timeout_s) + " s"};
    }
    if (report) report(RoundTrips().timed(stage.sample(), 0));
    clock.sleep_until(clock.now_s() + std::min(period_s, heartbeat_s));
  }
}

void require_referenced(Stage& stage) {
  if (stage.referenced()) return;
  throw Error{Fault::data,
              "stage: not referenced: the position of its zero is unknown; give --home, or run `vam-stage home` if the "
              "controller keeps the reference"};
}

namespace {

void require_zero_that_lasts(Stage& stage) {
  if (stage.keeps_zero()) return;
  throw Error{
      Fault::data,
      "stage: home=here: the zero is where the stage is when the command begins, so that an angle has no meaning "
      "to the next; give --relative"};
}

}  // namespace

void require_speed_in_range(Stage& stage, double speed_deg_s) {
  const double most_deg_s = stage.caps().max_speed_deg_s;
  if (most_deg_s <= 0 || speed_deg_s <= most_deg_s) return;
  throw Error{Fault::data, format_number(speed_deg_s) + " deg/s exceeds the stage's maximum of " +
                               format_number(most_deg_s) + "; give a lower --speed"};
}

void home(Stage& stage, Clock& clock, double timeout_s) {
  wait_until_standing(stage, clock, 0.02, braking_s);
  StopOnExit stopper(stage);
  stage.enable();
  stage.start_homing();
  const double deadline_s = clock.now_s() + timeout_s;
  while (!stage.homed()) {
    if (clock.now_s() > deadline_s) {
      throw Error{Fault::busy, "stage: no reference found within " + format_number(timeout_s) + " s"};
    }
    clock.sleep_until(clock.now_s() + 0.05);
  }
  stopper.disarm();
}

namespace {

// The controller decides; its limits explain why it refuses.
void start_move(Stage& stage, double target_deg) {
  try {
    stage.start_move(target_deg);
  } catch (const Error& error) {
    if (error.fault != Fault::protocol) throw;
    const StageCaps caps = stage.caps();
    if (target_deg >= caps.min_deg && target_deg <= caps.max_deg) throw;
    throw Error{Fault::data, "stage: " + format_number(target_deg, 7) + " deg is beyond its limits of travel, " +
                                 format_number(caps.min_deg) + " to " + format_number(caps.max_deg) +
                                 " deg; give another --angle"};
  }
}

// A drive that is off or blocked may report that it stands, as if it had arrived; one that has arrived may still
// settle.
void require_arrived(Stage& stage, Clock& clock, double target_deg) {
  constexpr double settled_deg = 0.1;  // what controllers take for arrived is far below
  constexpr double settling_s = 1;
  const double deadline_s = clock.now_s() + settling_s;
  for (;;) {
    const StageSample now = stage.sample();
    if (std::abs(now.angle_deg - target_deg) <= settled_deg + 2 * now.step_deg) return;
    if (clock.now_s() > deadline_s) {
      throw Error{Fault::protocol, "stage: stands at " + format_number(now.angle_deg, 7) + " deg, not at " +
                                       format_number(target_deg, 7) + "; it is blocked, or its drive is off"};
    }
    clock.sleep_until(clock.now_s() + 0.02);
  }
}

}  // namespace

void move(Stage& stage, Clock& clock, double angle_deg, bool relative, double speed_deg_s, double timeout_s) {
  require_speed_in_range(stage, speed_deg_s);
  if (!relative) require_zero_that_lasts(stage);
  if (!relative) require_referenced(stage);
  wait_until_standing(stage, clock, 0.02, braking_s);
  StopOnExit stopper(stage);
  stage.enable();
  stage.set_speed(speed_deg_s);
  const double target_deg = relative ? stage.sample().angle_deg + angle_deg : angle_deg;
  start_move(stage, target_deg);
  wait_until_standing(stage, clock, 0.02, timeout_s);
  if (const auto problem = stage.fault()) throw Error{Fault::protocol, "stage: stopped with error " + *problem};
  require_arrived(stage, clock, target_deg);
  stopper.disarm();
}

void halt(Stage& stage, Clock& clock, Stop how) {
  stage.stop(how);
  wait_until_standing(stage, clock, 0.005, 10);
}

void follow(Stage& stage, Clock& clock, double period_s, std::optional<double> seconds,
            const std::function<void(const AngleSample&)>& report) {
  const double start_s = clock.now_s();
  RoundTrips trips;
  RippleFilter middles;
  const double samples = seconds ? std::ceil(*seconds / period_s - 1e-6) : 0;  // one at the start, none at the end
  for (long n = 0; !seconds || static_cast<double>(n) < samples; ++n) {
    clock.sleep_until(start_s + static_cast<double>(n) * period_s);
    const AngleSample now = trips.timed(stage.sample(), middles.ready() ? middles.speed_deg_s() : 0);
    learn(trips, middles);
    report(now);
  }
}

Json describe(Stage& stage) {
  Json about = with_mark(stage.identify());
  const StageCaps caps = stage.caps();
  about["min_deg"] = caps.min_deg;
  about["max_deg"] = caps.max_deg;
  if (caps.max_speed_deg_s > 0) about["max_speed_deg_s"] = caps.max_speed_deg_s;
  if (caps.acceleration_deg_s2 > 0) about["acceleration_deg_s2"] = caps.acceleration_deg_s2;
  return about;
}

Json status(Stage& stage) {
  const StageSample now = stage.sample();
  Json state{{"t_monotonic_s", 0.5 * (now.t0_s + now.t1_s)}, {"angle_deg", now.angle_deg}, {"moving", stage.moving()}};
  const auto problem = stage.fault();
  state["fault"] = problem ? Json(*problem) : Json(nullptr);
  return state;
}

}  // namespace vam::device
