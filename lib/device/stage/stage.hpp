// SPDX-License-Identifier: GPL-3.0-or-later
// The rotation stage as the tools see it; one backend per file (gcs_stage, tic_stage, grbl_stage, zaber_stage).
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "base/text/json_fwd.hpp"
#include "device/os/address.hpp"
#include "device/os/clock.hpp"
#include "device/os/lock.hpp"
#include "device/safety/guardian.hpp"

namespace vam::device {

/// What the controller knows about itself. Angles and speeds are those of the stage, in degrees.
struct StageCaps {
  double min_deg = 0;  // travel in the controller's present coordinates
  double max_deg = 0;
  double max_speed_deg_s = 0;      // 0: the controller does not say
  double acceleration_deg_s2 = 0;  // 0: the controller does not say
};

/// The angle at some moment between t0_s (question sent) and t1_s (answer complete), on the clock of the stage.
struct StageSample {
  double angle_deg = 0;
  double t0_s = 0;
  double t1_s = 0;
  double step_deg = 0;  // multiples of which the controller reports; 0: far below any error
};

enum class Stop { smooth, abrupt };

/// A turning stage. Calls return within their time-out and throw Error: absent (unplugged), busy (no answer in time),
/// protocol (a malformed answer, or an error code of the controller). From the first motion until the stage is known to
/// stand, the guardian holds the order to stop it; every good answer is a heartbeat. The destructor stops a stage that
/// still moves.
class Stage {
 public:
  virtual ~Stage() = default;
  /// maker, model, serial, firmware and what else the backend knows.
  virtual Json identify() = 0;
  virtual StageCaps caps() = 0;
  /// Powers the motor and holds the position.
  virtual void enable() = 0;
  /// Starts the search for the reference; homed() turns true when it is found. 0 deg is there.
  virtual void start_homing() = 0;
  virtual bool homed() = 0;
  /// False where the controller knows that its zero is not at the reference: it may stand anywhere.
  virtual bool referenced() { return true; }
  /// False where homing finds no place of the stage, but takes the present one: no zero outlasts the command.
  virtual bool keeps_zero() { return true; }
  virtual void set_speed(double deg_s) = 0;
  /// Declares the present angle of a standing stage to be angle_deg.
  virtual void set_angle(double angle_deg) = 0;
  /// Starts a motion to an absolute angle; several turns are several times 360.
  virtual void start_move(double angle_deg) = 0;
  virtual StageSample sample() = 0;
  virtual bool moving() = 0;
  /// Sends the order; moving() tells when the stage stands.
  virtual void stop(Stop how) = 0;
  /// The controller's error since the last call, empty when there is none.
  virtual std::optional<std::string> fault() = 0;

  /// Keeps the lock until the stage is closed.
  void hold(std::unique_ptr<DeviceLock> lock) { lock_ = std::move(lock); }

 private:
  std::unique_ptr<DeviceLock> lock_;
};

}  // namespace vam::device
