// SPDX-License-Identifier: GPL-3.0-or-later
// Source: Zaber ASCII Protocol Manual, firmware 6 and 7 (zaber.com/protocol-manual); for the speed that a motion takes
// from firmware 7.25 on, the reference of Zaber Motion Library, Axis.moveAbsolute.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <string_view>
#include <utility>

#include "base/text/json.hpp"
#include "base/text/text.hpp"
#include "device/safety/stop_order.hpp"
#include "device/stage/private/line_link.hpp"
#include "device/stage/stage_backends.hpp"

namespace vam::device {

namespace {

constexpr double zaber_timeout_s = 0.2;
constexpr double speed_units = 1.6384;                    // of maxspeed in a microstep per second
constexpr double acceleration_units = speed_units / 1e4;  // of accel in a microstep per second squared
constexpr double speed_with_motion = 7.25;                // firmware

// "@01 1 07 OK IDLE -- 0": device, axis, number of the question, answer, status, most urgent warning, data.
struct Reply {
  bool accepted;
  bool busy;
  std::string data;
};

struct Flag {
  std::string_view name;
  const char* meaning;
};
constexpr std::array flags_known{Flag{"FD", "driver disabled: too hot or too high a current"},
                                 Flag{"FQ", "encoder error"}, Flag{"FS", "stalled and stopped"},
                                 Flag{"FE", "limit sensor not reached or faulty"},
                                 Flag{"WL", "unexpected limit sensor; the stage may have slipped"}};

// Whether it is a fault, and not a remark: the first letter distinguishes them, but for the limit sensor.
bool is_fault(const std::string& flag) { return flag.front() == 'F' || flag == "WL"; }

std::string in_words(const std::string& flag) {
  for (const auto& [name, meaning] : flags_known) {
    if (flag == name) return flag + " (" + meaning + ")";
  }
  return flag;
}

class ZaberStage final : public Stage {
 public:
  ZaberStage(std::unique_ptr<Port> port, Clock& clock, const ZaberSettings& settings, Guardian* guardian)
      : link_(std::move(port)), clock_(clock), settings_(settings), stop_order_(guardian) {
    link_.port().write("\n");  // ends a command that an earlier user left incomplete
    firmware_ = number("get version");
    if (settings_.steps_per_deg == 0) settings_.steps_per_deg = cycle_steps() / 360;
  }

  ~ZaberStage() override {
    if (!stop_order_.standing()) return;
    try {
      link_.port().write(command_line("estop"));
    } catch (...) {
      // The line is dead for us; the guardian keeps its order.
    }
  }

  // No device has serial number 0 but a simulated one. Firmware 6 knows "deviceid" instead.
  Json identify() override {
    Reply id = ask("get device.id");
    if (!id.accepted) id = ask("get deviceid");
    const std::string serial = require(ask("get system.serial"), "get system.serial");
    return {{"maker", "Zaber"},
            {"model", "device " + id.data},
            {"serial", serial == "0" ? "0 (simulated)" : serial},
            {"firmware", format_number(firmware_)},
            {"axis", std::to_string(settings_.axis)},
            {"steps_per_deg", settings_.steps_per_deg}};
  }

  StageCaps caps() override {
    StageCaps caps;
    caps.min_deg = number("get limit.min") / settings_.steps_per_deg + offset_deg_;
    caps.max_deg = number("get limit.max") / settings_.steps_per_deg + offset_deg_;
    if (caps.min_deg > caps.max_deg) std::swap(caps.min_deg, caps.max_deg);
    caps.acceleration_deg_s2 = number("get accel") / acceleration_units / std::abs(settings_.steps_per_deg);
    return caps;
  }

  // The driver of a device that has found a fault stays off until it is enabled; firmware 6 does not know the command.
  void enable() override {
    const Reply reply = ask("driver enable");
    if (!reply.accepted && reply.data != "BADCOMMAND") require(reply, "driver enable");
  }

  void start_homing() override {
    watch();
    order("home");
    homing_ = true;
  }

  bool homed() override {
    if (!homing_) return true;
    if (ask("").busy) return false;
    if (const auto problem = fault()) {
      throw Error{Fault::protocol, link_.port().name() + ": homing failed with " + *problem};
    }
    if (!referenced()) throw Error{Fault::protocol, link_.port().name() + ": homing ended without a reference (WR)"};
    homing_ = false;
    offset_deg_ = 0;
    stop_order_.withdraw();
    return true;
  }

  // WR: no reference position; WH: a position that was not found by homing.
  bool referenced() override {
    const auto flags = warnings("warnings");
    return std::find(flags.begin(), flags.end(), "WR") == flags.end() &&
           std::find(flags.begin(), flags.end(), "WH") == flags.end();
  }

  void set_speed(double deg_s) override {
    speed_ = std::llround(deg_s * std::abs(settings_.steps_per_deg) * speed_units);
    if (firmware_ >= speed_with_motion || number("get maxspeed") == static_cast<double>(speed_)) return;
    order("set maxspeed " + std::to_string(speed_));
  }

  void set_angle(double angle_deg) override { offset_deg_ += angle_deg - sample().angle_deg; }

  // Without a reference the device takes no absolute motion.
  void start_move(double angle_deg) override {
    const bool absolute = referenced();
    const double from_deg = absolute ? offset_deg_ : sample().angle_deg;
    const long long steps = std::llround((angle_deg - from_deg) * settings_.steps_per_deg);
    watch();
    order((absolute ? "move abs " : "move rel ") + std::to_string(steps) +
          (firmware_ >= speed_with_motion && speed_ > 0 ? " " + std::to_string(speed_) : ""));
  }

  StageSample sample() override {
    StageSample now;
    link_.drain();
    now.t0_s = clock_.now_s();
    const double steps = number("get pos");
    now.t1_s = clock_.now_s();
    now.angle_deg = steps / settings_.steps_per_deg + offset_deg_;
    now.step_deg = 1 / std::abs(settings_.steps_per_deg);
    return now;
  }

  bool moving() override {
    const bool moves = ask("").busy;
    if (!moves) stop_order_.withdraw();
    return moves;
  }

  void stop(Stop how) override {
    stop_order_.beat();
    order(how == Stop::smooth ? "stop" : "estop");
    homing_ = false;
  }

  // Asking clears what does not last.
  std::optional<std::string> fault() override {
    std::string problems;
    for (const auto& flag : warnings("warnings clear")) {
      if (is_fault(flag)) problems += (problems.empty() ? "" : ", ") + in_words(flag);
    }
    return problems.empty() ? std::nullopt : std::optional(problems);
  }

 private:
  std::string command_line(const std::string& command, const std::string& number = "") const {
    return "/" + std::to_string(settings_.address) + " " + std::to_string(settings_.axis) +
           (number.empty() ? "" : " " + number) + (command.empty() ? "" : " " + command) + "\n";
  }

  // Questions are numbered, so that an answer that comes too late is not taken for that to the next one.
  Reply ask(const std::string& command) {
    question_ = question_ % 99 + 1;
    std::array<char, 8> id{};
    std::snprintf(id.data(), id.size(), "%02d", question_);
    link_.drain();
    link_.port().write(command_line(command, id.data()));
    for (;;) {
      const std::string line = link_.need_line(zaber_timeout_s);
      if (line.front() == '!' || line.front() == '#') continue;       // an alert, or more about an answer
      const auto words = split(line.substr(0, line.find(':')), ' ');  // a checksum may follow
      if (line.front() != '@' || words.size() < 7) throw link_.malformed(command, line);
      if (words[2] != id.data()) continue;
      return read(command, line, words);
    }
  }

  Reply read(const std::string& command, const std::string& line, const std::vector<std::string>& words) {
    const auto sender = parse_number(words[0].substr(1));
    if (sender != settings_.address) {
      throw Error{Fault::protocol, link_.port().name() + ": '" + command + "' was answered by device " +
                                       words[0].substr(1) + " instead of " + std::to_string(settings_.address)};
    }
    const bool known = (words[3] == "OK" || words[3] == "RJ") && (words[4] == "BUSY" || words[4] == "IDLE");
    if (!known) throw link_.malformed(command, line);
    stop_order_.beat();
    return {words[3] == "OK", words[4] == "BUSY", join({words.begin() + 6, words.end()}, " ")};
  }

  std::string require(const Reply& reply, const std::string& command) const {
    if (reply.accepted) return reply.data;
    throw Error{Fault::protocol, link_.port().name() + ": '" + command + "' was refused with " + reply.data};
  }

  void order(const std::string& command) { require(ask(command), command); }

  double number(const std::string& command) {
    const std::string text = require(ask(command), command);
    const auto value = parse_number(text);
    if (!value || !std::isfinite(*value)) throw link_.malformed(command, text);
    return *value;
  }

  // "02 FS WR"
  std::vector<std::string> warnings(const std::string& command) {
    auto flags = split(require(ask(command), command), ' ');
    const auto count = parse_number(flags.front());
    if (!count || *count != static_cast<double>(flags.size() - 1)) throw link_.malformed(command, join(flags, " "));
    flags.erase(flags.begin());
    return flags;
  }

  double cycle_steps() {
    const Reply reply = ask("get limit.cycle.dist");
    const auto steps = reply.accepted ? parse_number(reply.data) : std::nullopt;
    if (steps && *steps > 0) return *steps;
    throw Error{Fault::data, link_.port().name() +
                                 ": the device reports no number of microsteps per turn (limit.cycle.dist): it is "
                                 "not a rotary stage, or requires ?steps_per_deg=N"};
  }

  // The LF ends half a line of the dead tool; the stop is for a device that does not know estop.
  void watch() { stop_order_.give("\n" + command_line("stop") + command_line("estop"), link_.port().handle()); }

  LineLink link_;
  Clock& clock_;
  ZaberSettings settings_;
  StopOrder stop_order_;
  int question_ = 0;
  double firmware_ = 0;
  long long speed_ = 0;  // as maxspeed; 0: the device's
  double offset_deg_ = 0;
  bool homing_ = false;
};

}  // namespace

std::unique_ptr<Stage> make_zaber_stage(std::unique_ptr<Port> port, Clock& clock, const ZaberSettings& settings,
                                        Guardian* guardian) {
  return std::make_unique<ZaberStage>(std::move(port), clock, settings, guardian);
}

}  // namespace vam::device
