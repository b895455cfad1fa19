// SPDX-License-Identifier: GPL-3.0-or-later
// The mechanics of a simulated rotation stage: a stage with inertia behind a speed-limited drive.
#pragma once

namespace vam::sim {

struct MotorSettings {
  double acceleration_deg_s2 = 60;
  double brake_deg_s2 = 3000;  // abrupt stop
  double coast_deg_s2 = 200;   // friction, without power
  double speed_error = 0;      // relative: 0.01 turns 1 % too fast
  double ripple = 0;           // relative amplitude of the speed error that repeats with every 30 deg (worm, gear)
};

/// Moves in steps of 0.5 ms of the time it is given, so its path does not depend on the sampling; between two steps at
/// the speed of the first.
class SimMotor {
 public:
  SimMotor(const MotorSettings& settings, double start_s)
      : settings_(settings), asked_s_(start_s), stepped_s_(start_s) {}

  void advance(double to_s);
  void go_to(double target_deg);
  void set_speed(double deg_s) { speed_limit_deg_s_ = deg_s; }
  void halt() { mode_ = Mode::halting; }   // at the normal acceleration
  void brake() { mode_ = Mode::braking; }  // as hard as it can
  void cut_power() { mode_ = Mode::coasting; }
  /// Declares the present angle of a standing stage.
  void set_angle(double angle_deg);

  [[nodiscard]] double angle_deg() const { return angle_deg_ + speed_deg_s() * (asked_s_ - stepped_s_); }
  [[nodiscard]] double target_deg() const { return target_deg_; }
  /// Of the stage, what an observer would measure.
  [[nodiscard]] double speed_deg_s() const;
  [[nodiscard]] bool moving() const { return mode_ != Mode::standing; }

 private:
  enum class Mode { standing, travelling, halting, braking, coasting };
  void step();
  double wanted_speed_deg_s() const;

  MotorSettings settings_;
  Mode mode_ = Mode::standing;
  double asked_s_;    // time up to which it was to advance
  double stepped_s_;  // of the last step, at most one before
  double angle_deg_ = 0;
  double drive_deg_s_ = 0;  // what the drive believes
  double target_deg_ = 0;
  double speed_limit_deg_s_ = 10;
};

}  // namespace vam::sim
