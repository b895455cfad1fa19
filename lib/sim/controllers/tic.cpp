// SPDX-License-Identifier: GPL-3.0-or-later
// Sources, named beside each behaviour: Pololu's Tic Stepper Motor Controller User's Guide, chapters "Variable
// reference" and "Command reference"; codes and offsets also in Pololu's own software
// (github.com/pololu/pololu-tic-software, include/tic_protocol.h).
#include "sim/controllers/tic.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "base/error.hpp"
#include "base/text/json.hpp"

namespace vam::sim {

namespace {

class SimTic final : public device::UsbLink {
 public:
  SimTic(const SimTicSettings& settings, device::Clock& clock, SimLog log)
      : settings_(settings), clock_(clock), log_(std::move(log)), motor_(settings.motor, clock.now_s()) {
    heard_s_ = clock.now_s();
    uncertain_ = !settings.referenced;
  }

  void control_out(int request, int value, int index) override {
    advance();
    refuse_if_spoilt();
    heard_s_ = clock_.now_s();
    timed_out_ = false;
    const auto argument =
        static_cast<std::int32_t>(static_cast<std::uint32_t>(index) << 16U | static_cast<std::uint32_t>(value));
    switch (request) {
      case 0x85:
        if (!energized_) energized_s_ = clock_.now_s();
        energized_ = true;
        break;  // Energize
      case 0x83:
        safe_start_ = violated_ = false;
        break;  // Exit safe start: motion is refused before
      case 0x8C:
        break;  // Reset command timeout, as every other command does, too
      case 0x89:
        brake();
        break;  // Halt and hold: abruptly, so that the position is uncertain
      case 0xE3:
        slow_to(argument);
        break;  // Set target velocity: 0 decelerates
      case 0xE6:
        motor_.set_speed(argument * 1e-4 / settings_.steps_per_deg);
        break;  // Set max speed: microsteps per 10 000 s
      case 0xEC:
        motor_.set_angle(angle(argument));
        uncertain_ = homing_ = to_position_ = false;
        break;  // Halt and set position: clears the position uncertain flag
      case 0x97:
        homing_ = true;
        go(0);
        break;  // Go home: to the limit switch, where the position is 0 and certain
      case 0xE0:
        to_position_ = true;
        go(angle(argument));
        break;  // Set target position
      default:
        throw Error{Fault::protocol, name_ + ": stalled request " + std::to_string(request)};
    }
  }

  std::string control_in(int request, int, int index, int length) override {
    advance();
    if (request != 0xA1) throw Error{Fault::protocol, name_ + ": stalled request " + std::to_string(request)};
    refuse_if_spoilt();  // "Get variable" is no command: the time-out goes on (section 5.4)
    std::string answer = packed(variable(index), length);
    if (spoils("garbage")) return std::string(answer.size(), '\x5A');
    if (spoils("truncated")) {  // as the link to a real one says
      throw Error{Fault::protocol,
                  name_ + ": answered " + std::to_string(length / 2) + " bytes instead of " + std::to_string(length)};
    }
    return answer;
  }

  void write_report(const std::string&) override { throw Error{Fault::protocol, name_ + ": has no reports"}; }
  std::string read_report() override { throw Error{Fault::protocol, name_ + ": has no reports"}; }
  const std::string& name() const override { return name_; }
  Json about() const override {
    return {{"usb_id", "1ffb:00b3"},
            {"serial", "00312345"},
            {"maker", "Pololu Corporation (simulated)"},
            {"model", "Tic T825"},
            {"firmware", "1.06"}};
  }

 private:
  [[nodiscard]] bool spoils(const char* fault) const {
    return settings_.fault == fault && transfers_ > settings_.fault_after;
  }

  void refuse_if_spoilt() {
    ++transfers_;
    if (spoils("unplug")) throw Error{Fault::absent, name_ + ": is gone (LIBUSB_ERROR_NO_DEVICE)"};
    if (spoils("error")) throw Error{Fault::protocol, name_ + ": refused the request (LIBUSB_ERROR_PIPE)"};
    if (!spoils("silent")) return;
    clock_.sleep_until(clock_.now_s() + 0.25);
    throw Error{Fault::busy, name_ + ": no answer (LIBUSB_ERROR_TIMEOUT)"};
  }

  double angle(std::int32_t steps) const { return steps / settings_.steps_per_deg; }

  void go(double angle_deg) {
    if (!energized_ || safe_start_) return;
    motor_.go_to(angle_deg);
    note("moving");
  }

  void note(const std::string& event) {
    if (log_) log_({{"t_monotonic_s", clock_.now_s()}, {"event", event}, {"angle_deg", motor_.angle_deg()}});
  }

  // Settings, "Command timeout": stops when no command came for so long.
  void brake() {
    motor_.brake();
    uncertain_ = true;
    homing_ = to_position_ = false;
    note("halt");
  }

  void slow_to(std::int32_t speed) {
    if (speed != 0) throw Error{Fault::protocol, name_ + ": velocity commands are not supported"};
    to_position_ = false;
    motor_.halt();
    note("slowing");
  }

  void advance() {
    const bool moved = motor_.moving();
    motor_.advance(std::min(clock_.now_s(), heard_s_ + settings_.command_timeout_s));
    if (clock_.now_s() > heard_s_ + settings_.command_timeout_s && energized_) {
      motor_.halt();
      timed_out_ = safe_start_ = violated_ = true;  // a violation stays until "Exit safe start"
      homing_ = false;                              // and the position stays uncertain
    }
    motor_.advance(clock_.now_s());
    if (homing_ && !motor_.moving()) homing_ = uncertain_ = false;  // the limit switch
    if (moved && !motor_.moving()) note("standing");
  }

  // For 10 ms after the motor is energized, until the current of its coils is steady (operation state 8).
  [[nodiscard]] bool starts_up() const { return clock_.now_s() < energized_s_ + 0.01; }

  // Variable reference, by offset: operation state (2 de-energized, 4 soft error, 8 starting up, 10 normal) and the
  // flags after it, misc flags 1 (bits 0 energized, 1 position uncertain, 4 homing active), error status, planning
  // mode, target position, max acceleration (microsteps per 100 s^2), current position, current velocity (microsteps
  // per 10 000 s).
  std::int64_t variable(int offset) const {
    const auto steps = [&](double deg) { return std::llround(deg * settings_.steps_per_deg); };
    switch (offset) {
      case 0x00:
        return (variable(0x02) != 0 ? 4 : !energized_ ? 2 : starts_up() ? 8 : 10) | variable(0x01) << 8;
      case 0x01:
        return (energized_ ? 1 : 0) | (uncertain_ ? 2 : 0) | (homing_ ? 16 : 0);
      case 0x02:
        return settings_.error_bits | (timed_out_ ? command_timeout_bit : 0) | (violated_ ? violation_bit : 0);
      case 0x09:
        return to_position_ ? 1 : 0;
      case 0x0A:
        return steps(motor_.target_deg());
      case 0x1E:
        return steps(settings_.motor.acceleration_deg_s2) * 100;
      case 0x22:
        return steps(motor_.angle_deg());
      case 0x26:
        return steps(motor_.speed_deg_s()) * 10000;
      default:
        return 0;
    }
  }

  static std::string packed(std::int64_t value, int length) {
    std::string bytes;
    for (int i = 0; i < length; ++i) bytes += static_cast<char>(static_cast<std::uint64_t>(value) >> (8 * i) & 0xFFU);
    return bytes;
  }

  SimTicSettings settings_;
  device::Clock& clock_;
  SimLog log_;
  SimMotor motor_;
  static constexpr int command_timeout_bit = 1 << 6, violation_bit = 1 << 7;
  double heard_s_ = 0, energized_s_ = -1;
  bool timed_out_ = false, violated_ = false;
  int transfers_ = 0;
  bool energized_ = false;
  bool safe_start_ = true;
  bool uncertain_ = true;
  bool homing_ = false;
  bool to_position_ = false;
  std::string name_ = "sim: (Tic T825)";
};

}  // namespace

std::unique_ptr<device::UsbLink> make_sim_tic(const SimTicSettings& settings, device::Clock& clock, SimLog log) {
  return std::make_unique<SimTic>(settings, clock, std::move(log));
}

}  // namespace vam::sim
