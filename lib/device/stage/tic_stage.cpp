// SPDX-License-Identifier: GPL-3.0-or-later
#include <array>
#include <cmath>
#include <cstring>
#include <utility>

#include "base/error.hpp"
#include "base/text/json.hpp"
#include "base/text/text.hpp"
#include "device/safety/guardian_actions.hpp"
#include "device/safety/stop_order.hpp"
#include "device/stage/stage_backends.hpp"

namespace vam::device {

namespace {

// Pololu Tic User's Guide, "Command reference" and "Variable reference".
enum Request {
  set_target_position = 0xE0,
  set_target_velocity = 0xE3,
  halt_and_set_position = 0xEC,
  halt_and_hold = 0x89,
  go_home = 0x97,
  reset_command_timeout = 0x8C,
  energize = 0x85,
  exit_safe_start = 0x83,
  set_max_speed = 0xE6,
  get_variable = 0xA1,
};
enum Offset {
  operation_state = 0x00,  // the miscellaneous flags follow
  error_status = 0x02,
  planning_mode = 0x09,
  target_position = 0x0A,
  max_speed = 0x16,
  max_acceleration = 0x1E,
  current_position = 0x22,
  current_velocity = 0x26
};
constexpr int state_starting_up = 8;  // for up to 10 ms, until the current of the coils is steady
constexpr int state_normal = 10;      // the others are 0, 2, 4 and 6
constexpr int homing_active = 1 << 4;
constexpr int position_uncertain = 1 << 1;
constexpr int unused_flags = 0xE0;
constexpr int to_position = 1;                   // planning mode
constexpr double speed_unit_hz = 1e-4;           // speeds count microsteps per 10,000 s
constexpr double acceleration_unit_hz_s = 1e-2;  // accelerations count microsteps per second per 100 s

const std::array<const char*, 11> error_names{"intentionally de-energized",
                                              "motor driver error",
                                              "low VIN",
                                              "kill switch active",
                                              "required input invalid",
                                              "serial error",
                                              "command time-out",
                                              "safe start violation",
                                              "ERR line high",
                                              "?",
                                              "?"};

class TicStage final : public Stage {
 public:
  TicStage(std::unique_ptr<UsbLink> link, Clock& clock, double steps_per_deg, Guardian* guardian)
      : link_(std::move(link)), clock_(clock), steps_per_deg_(steps_per_deg), stop_order_(guardian) {}

  ~TicStage() override {
    if (!stop_order_.standing()) return;
    try {
      link_->control_out(halt_and_hold, 0, 0);
    } catch (...) {
      // The guardian keeps the order, and the Tic has its own command time-out.
    }
  }

  Json identify() override {
    Json about = link_->about();
    about["steps_per_deg"] = steps_per_deg_;
    return about;
  }

  StageCaps caps() override {
    StageCaps caps;
    const double reach_deg = 2147483647.0 / std::abs(steps_per_deg_);  // positions are 32-bit
    caps.min_deg = -reach_deg;
    caps.max_deg = reach_deg;
    caps.acceleration_deg_s2 = variable(max_acceleration) * acceleration_unit_hz_s / std::abs(steps_per_deg_);
    return caps;
  }

  void enable() override {
    order(energize, 0);
    order(exit_safe_start, 0);
    if (const auto problem = fault()) throw Error{Fault::protocol, link_->name() + ": motor not enabled: " + *problem};
  }

  void start_homing() override {
    watch();
    order_short(go_home, 0);
  }

  bool homed() override {
    order(reset_command_timeout, 0);
    const auto [state, flags] = state_now();
    if ((flags & homing_active) != 0 && (state == state_normal || state == state_starting_up)) return false;
    if (const auto problem = fault()) throw Error{Fault::protocol, link_->name() + ": homing failed: " + *problem};
    if ((flags & position_uncertain) != 0)
      throw Error{Fault::protocol, link_->name() + ": homing ended without a limit switch"};
    stop_order_.withdraw();
    return true;
  }

  bool referenced() override { return (state_now().second & position_uncertain) == 0; }

  void set_speed(double deg_s) override {
    const double hz = deg_s * std::abs(steps_per_deg_);
    if (hz > 50000) {
      throw Error{Fault::data,
                  format_number(deg_s) + " deg/s is " + format_number(hz) + " steps/s; the maximum of a Tic is 50000"};
    }
    order(set_max_speed, static_cast<std::int32_t>(std::lround(hz / speed_unit_hz)));
  }

  void set_angle(double angle_deg) override { order(halt_and_set_position, steps(angle_deg)); }

  void start_move(double angle_deg) override {
    watch();
    order(set_target_position, steps(angle_deg));
  }

  StageSample sample() override {
    StageSample now;
    now.t0_s = clock_.now_s();
    now.angle_deg = variable(current_position) / steps_per_deg_;
    now.t1_s = clock_.now_s();
    now.step_deg = 1 / std::abs(steps_per_deg_);
    order(reset_command_timeout, 0);
    return now;
  }

  bool moving() override {
    order(reset_command_timeout, 0);
    (void)state_now();  // noise must not pass for a motion either
    const bool moves = variable(current_velocity) != 0 || ((variable(planning_mode) & 0xFF) == to_position &&
                                                           variable(target_position) != variable(current_position));
    if (!moves) stop_order_.withdraw();
    return moves;
  }

  // Halt and hold stops without a ramp, may lose steps, and makes the position uncertain (Tic User's Guide, chapter 8).
  void stop(Stop how) override {
    if (how == Stop::smooth) return order(set_target_velocity, 0);
    order(halt_and_hold, 0);
  }

  std::optional<std::string> fault() override {
    const std::string bytes = link_->control_in(get_variable, 0, error_status, 2);
    const int bits = static_cast<unsigned char>(bytes[0]) | static_cast<unsigned char>(bytes[1]) << 8;
    stop_order_.beat();
    std::vector<std::string> names;
    for (std::size_t bit = 0; bit < 11; ++bit) {
      if ((bits >> bit & 1) != 0) names.emplace_back(error_names[bit]);
    }
    return names.empty() ? std::nullopt : std::optional(join(names, ", "));
  }

 private:
  std::int32_t steps(double angle_deg) const {
    return static_cast<std::int32_t>(std::lround(angle_deg * steps_per_deg_));
  }

  // A 32-bit argument travels as wValue (low half) and wIndex (high half).
  void order(Request request, std::int32_t argument) {
    const auto bits = static_cast<std::uint32_t>(argument);
    link_->control_out(request, static_cast<int>(bits & 0xFFFFU), static_cast<int>(bits >> 16U));
    stop_order_.beat();
  }
  void order_short(Request request, int argument) {
    link_->control_out(request, argument, 0);
    stop_order_.beat();
  }

  std::int32_t variable(Offset offset) {
    const std::string bytes = link_->control_in(get_variable, 0, offset, 4);
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < 4; ++i)
      value |= static_cast<std::uint32_t>(static_cast<unsigned char>(bytes[i])) << 8 * i;
    stop_order_.beat();
    return static_cast<std::int32_t>(value);
  }

  // Noise must not pass for "still searching".
  std::pair<int, int> state_now() {
    const std::string bytes = link_->control_in(get_variable, 0, operation_state, 2);
    const int state = static_cast<unsigned char>(bytes[0]);
    const int flags = static_cast<unsigned char>(bytes[1]);
    if (state > state_normal || state % 2 != 0 || (flags & unused_flags) != 0) {
      throw Error{Fault::protocol, link_->name() + ": its state " + to_hex(bytes) + " is unknown"};
    }
    stop_order_.beat();
    return {state, flags};
  }

  void watch() {
    const Json about = link_->about();
    stop_order_.give({{"do", "usb"},
                      {"order", 1},
                      {"name", "stage"},
                      {"usb_id", about["usb_id"]},
                      {"serial", about["serial"]},
                      {"interface", -1},
                      {"control", Json::array({Json::array({halt_and_hold, 0, 0})})}});
  }

  std::unique_ptr<UsbLink> link_;
  Clock& clock_;
  double steps_per_deg_;
  StopOrder stop_order_;
};

}  // namespace

std::unique_ptr<Stage> make_tic_stage(std::unique_ptr<UsbLink> link, Clock& clock, double steps_per_deg,
                                      Guardian* guardian) {
  return std::make_unique<TicStage>(std::move(link), clock, steps_per_deg, guardian);
}

}  // namespace vam::device
