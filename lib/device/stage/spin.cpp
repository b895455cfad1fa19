// SPDX-License-Identifier: GPL-3.0-or-later
#include "device/stage/spin.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "base/error.hpp"
#include "base/text/text.hpp"
#include "device/stage/angle_fit.hpp"
#include "device/stage/private/ripple_filter.hpp"
#include "device/stage/private/stop_on_exit.hpp"

namespace vam::device {

namespace {

constexpr double assumed_acceleration_deg_s2 = 40;  // when the controller does not say
constexpr double judged_s = 0.6;  // before angle 0: a following projector is informed in time, and stays dark
constexpr double settle_s = 1.6;  // at speed before angle 0: the fit's window, and the time before

struct Course {
  double start_deg;  // of printing coordinates
  double end_deg;
  double cruise_deg;  // from here on the stage keeps its speed
  double cruise_s;    // and this long after the start it must have got there
};

// Where the run starts: early enough for ramp and run-up, and congruent with the stage's present angle, so that angle 0
// is at the stage's zero.
Course plot(const SpinPlan& plan, const StageCaps& caps, double here_deg) {
  const double acceleration = caps.acceleration_deg_s2 > 0 ? caps.acceleration_deg_s2 : assumed_acceleration_deg_s2;
  const double ramp_deg = plan.speed_deg_s * plan.speed_deg_s / (2 * acceleration);
  const double before_deg = ramp_deg + plan.speed_deg_s * settle_s + 360 * plan.run_up_turns;
  const double phase = std::remainder(here_deg, 360.0);
  Course course{};
  course.start_deg = phase - 360 * std::ceil((before_deg + phase) / 360);
  course.cruise_deg = course.start_deg + 1.2 * ramp_deg + 0.2 * plan.speed_deg_s;
  course.cruise_s = 2 * (plan.speed_deg_s / acceleration + 0.2) + 1;
  // Beyond the last turn, so that the stage is still at full speed when that ends.
  course.end_deg = 360.0 * plan.turns + 1.5 * ramp_deg + 0.5 * plan.speed_deg_s;
  const double low = std::min(plan.direction * course.start_deg, plan.direction * course.end_deg);
  const double high = std::max(plan.direction * course.start_deg, plan.direction * course.end_deg);
  if (low < caps.min_deg || high > caps.max_deg) {
    throw Error{Fault::data, std::to_string(plan.turns) + " turns require travel from " + format_number(low) + " to " +
                                 format_number(high) + " deg, but the controller allows " +
                                 format_number(caps.min_deg) + " to " + format_number(caps.max_deg) +
                                 "; use fewer turns or extend the limits of travel"};
  }
  return course;
}

void require_speed(const SpinPlan& plan, const AngleFit& fit) {
  if (!fit.ready()) {
    throw Error{Fault::protocol, "stage: too few angle samples in the run-up to determine the speed"};
  }
  const double off = std::abs(fit.speed_deg_s() - plan.speed_deg_s);
  if (off > plan.speed_tolerance * plan.speed_deg_s + 3 * fit.speed_sigma_deg_s()) {
    throw Error{Fault::protocol, "stage: speed is " + format_number(fit.speed_deg_s(), 4) + " deg/s instead of " +
                                     format_number(plan.speed_deg_s) + " (" +
                                     format_number(100 * off / plan.speed_deg_s, 2) + " % error, limit " +
                                     format_number(100 * plan.speed_tolerance) +
                                     " %); check load and controller parameters"};
  }
}

// A blocked or slipping stage leaves its line long before a turn is over.
void require_on_line(const AngleFit& fit, const AngleSample& now) {
  if (!fit.ready()) return;
  const AngleSample expected = fit.at(now.t_s);
  const double allowed_deg = 2.0 + 6 * (now.sigma_deg + expected.sigma_deg);
  if (std::abs(expected.angle_deg - now.angle_deg) > allowed_deg) {
    throw Error{Fault::protocol, "stage: is at " + format_number(now.angle_deg, 7) + " deg where " +
                                     format_number(expected.angle_deg, 7) +
                                     " was expected; it slipped, was blocked or stopped"};
  }
}

Course start_moving(Stage& stage, const SpinPlan& plan, const StageCaps& caps) {
  stage.enable();
  const Course course = plot(plan, caps, plan.direction * stage.sample().angle_deg);
  stage.set_angle(plan.direction * course.start_deg);
  stage.set_speed(plan.speed_deg_s);
  stage.start_move(plan.direction * course.end_deg);
  return course;
}

void require_moving(const Course& course, const AngleSample& now, double passed_s) {
  if (passed_s <= course.cruise_s) return;
  throw Error{Fault::protocol, "stage: moved only " + format_number(now.angle_deg - course.start_deg, 4) + " deg in " +
                                   format_number(course.cruise_s, 3) + " s; it is blocked or its drive is off"};
}

}  // namespace

SpinCourse plan_spin(Stage& stage, const SpinPlan& plan, bool after_homing) {
  const StageCaps caps = stage.caps();
  require_speed_in_range(stage, plan.speed_deg_s);
  if (!after_homing) require_referenced(stage);
  const double here_deg = after_homing ? 0 : plan.direction * stage.sample().angle_deg;
  const Course course = plot(plan, caps, here_deg);
  const double acceleration = caps.acceleration_deg_s2 > 0 ? caps.acceleration_deg_s2 : assumed_acceleration_deg_s2;
  const double seconds =
      (360 * plan.turns - course.start_deg) / plan.speed_deg_s + 1.5 * plan.speed_deg_s / acceleration;
  const bool turned = plan.direction < 0;
  return {course.start_deg, course.end_deg, turned ? -caps.max_deg : caps.min_deg,
          turned ? -caps.min_deg : caps.max_deg, seconds};
}

void spin(Stage& stage, Clock& clock, const SpinPlan& plan, const std::function<void(const AngleSample&)>& report) {
  const StageCaps caps = stage.caps();
  require_speed_in_range(stage, plan.speed_deg_s);
  require_referenced(stage);
  wait_until_standing(stage, clock, plan.period_s, braking_s);
  StopOnExit stopper(stage);
  const Course course = start_moving(stage, plan, caps);
  const double longest_s = 2 * (course.end_deg - course.start_deg) / plan.speed_deg_s + 10;
  const double start_s = clock.now_s();
  const double looks = std::ceil(plan.period_s / heartbeat_s);  // for every sample that is reported
  const double period_s = plan.period_s / looks;
  const auto explained = [&](const auto& require) {  // what the controller knows of it comes with it
    try {
      require();
    } catch (const Error& error) {
      const auto problem = stage.fault();
      if (!problem) throw;
      throw Error{error.fault, std::string(error.what()) + "; the controller reports: " + *problem};
    }
  };
  RoundTrips trips;
  AngleFit line;
  RippleFilter middles;
  bool judged = false;
  long look = 0;
  for (double next_s = start_s;; next_s += period_s) {
    clock.sleep_until(next_s);
    next_s = std::max(next_s, clock.now_s() - period_s);  // late samples are not made up for
    StageSample raw = stage.sample();
    raw.angle_deg *= plan.direction;
    AngleSample now = trips.timed(raw, plan.speed_deg_s);
    now.ramp = now.angle_deg < course.cruise_deg;
    if (now.angle_deg >= -judged_s * plan.speed_deg_s && !std::exchange(judged, true)) require_speed(plan, line);
    if (now.ramp) {
      explained([&] { require_moving(course, now, clock.now_s() - start_s); });
    } else {
      explained([&] { require_on_line(line, trips.middle()); });
      line.add(trips.middle());
      learn(trips, middles);
    }
    const bool ended = now.angle_deg >= 360.0 * plan.turns;
    if (ended || look++ % std::lround(looks) == 0) report(now);
    if (ended) break;
    if (clock.now_s() - start_s > longest_s) {
      throw Error{Fault::busy, "stage: " + format_number(now.angle_deg, 6) + " deg after " + format_number(longest_s) +
                                   " s, where " + std::to_string(360 * plan.turns) + " was expected"};
    }
  }
  stage.stop(Stop::smooth);
  wait_until_standing(stage, clock, plan.period_s, 10);
  stopper.disarm();
}

}  // namespace vam::device
