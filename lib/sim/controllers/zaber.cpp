// SPDX-License-Identifier: GPL-3.0-or-later
// Sources, named beside each behaviour: "manual" is the Zaber ASCII Protocol Manual of the maker, firmware 6.06 to 7
// (zaber.com/wiki/Manuals/ASCII_Protocol_Manual, zaber.com/protocol-manual); "library" is the reference of the maker's
// Zaber Motion Library. The stage is an X-RSW60A: 384 000 microsteps a turn (its data sheet: 0.0009375 deg each).
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <set>
#include <utility>

#include "base/index.hpp"
#include "base/text/json.hpp"
#include "base/text/text.hpp"
#include "sim/controllers/controllers.hpp"
#include "sim/controllers/private/controller.hpp"

namespace vam::sim {

namespace {

constexpr double steps_per_turn = 384000;
constexpr double steps_per_deg = steps_per_turn / 360;
constexpr double speed_units = 1.6384;      // manual, "maxspeed": microsteps per second times 1.6384
constexpr double speed_bound = 64 * 16384;  // manual, "maxspeed": at most resolution (64) times 16384

class SimZaber final : public SimController {
 public:
  SimZaber(const SimGcsSettings& settings, double now_s, SimLog log)
      : SimController(settings, now_s, std::move(log)), zero_deg_(settings.home_deg) {
    max_speed_ = std::llround(settings.max_speed_deg_s * steps_per_deg * speed_units);
  }

 private:
  // Manual, "Command": a command ends with CR, LF or both.
  void on_byte(char c) override {
    if (c != '\n' && c != '\r') {
      line_ += c;
    } else if (!line_.empty()) {
      handle(std::exchange(line_, ""));
    }
  }

  // Manual, "Alerts": when a motion ends, "!01 1 IDLE --", if comm.alert is 1, as here.
  void on_standing() override {
    if (std::exchange(homing_, false)) {
      zero_deg_ = 0;
      warnings_.erase("WR");  // manual, "WR": until the position is updated by homing
    }
    answer("!" + two_digits(settings_.address) + " 1 IDLE " + worst() + "\r\n");
  }

  static std::string two_digits(int value) {
    std::array<char, 8> text{};
    std::snprintf(text.data(), text.size(), "%02d", value);
    return text.data();
  }

  // Manual, "Warning flags": the most urgent first, "--" for none.
  std::string worst() const {
    for (const char* flag : {"FS", "WR", "NI"}) {
      if (warnings_.contains(flag)) return flag;
    }
    return "--";
  }

  // "/1 1 07 get pos". Manual, "Command": "/", then device, axis and message number where given; device 0, or none, is
  // everyone, axis 0 every axis. What does not begin with "/" is not a command.
  void handle(const std::string& line) {
    if (line.front() != '/') return;
    auto words = split(line.substr(1), ' ');
    std::erase(words, "");
    std::vector<int> numbers;
    while (!words.empty() && numbers.size() < 3 && words.front().find_first_not_of("0123456789") == std::string::npos) {
      numbers.push_back(std::stoi(words.front()));
      words.erase(words.begin());
    }
    if (!numbers.empty() && numbers[0] != 0 && numbers[0] != settings_.address) return;
    const int axis = numbers.size() > 1 ? numbers[1] : 0;
    // Get, set and move are distinguished by their second word.
    const bool two =
        !words.empty() && (words[0] == "get" || words[0] == "set" || words[0] == "move") && words.size() > 1;
    const std::string command = two ? words[0] + " " + words[1] : words.empty() ? "" : words[0];
    words.erase(words.begin(), words.begin() + std::min<long>(two ? 2 : 1, static_cast<long>(words.size())));
    const std::string fault = record_command(line, command);
    if (silent()) return;
    if (fault == "stall") stall();
    const std::string data = fault == "error" ? "!BADDATA" : axis > 1 ? "!BADAXIS" : reply(command, words);
    const bool refused = data.front() == '!';
    const int sender = fault == "wrong-sender" ? 7 : settings_.address;
    // Manual, "Reply": "@01 1 07 OK IDLE -- 0": BUSY while the axis moves; the message number only where one was given.
    reply_with_fault(fault == "wrong-sender" ? "" : fault,
                     "@" + two_digits(sender) + " " + std::to_string(axis) + " " +
                         (numbers.size() > 2 ? two_digits(numbers[2]) + " " : "") + (refused ? "RJ " : "OK ") +
                         (motor_.moving() ? "BUSY " : "IDLE ") + worst() + " " + data.substr(refused ? 1 : 0) + "\r\n",
                     "");
  }

  // The data of the answer, with "!" before the reason of a refusal (manual, "Reply flags").
  std::string reply(const std::string& command, const std::vector<std::string>& words) {
    if (command.empty()) return "0";
    if (command == "warnings") return list_warnings(!words.empty() && words[0] == "clear");
    if (command == "home") return home();
    if (command == "stop") return stop(&SimMotor::halt);    // manual, "stop": decelerates
    if (command == "estop") return stop(&SimMotor::brake);  // manual, "estop": as fast as it can
    if (command == "driver") return settings_.old_firmware ? "!BADCOMMAND" : "0";
    if (command.rfind("get ", 0) == 0) return setting(command.substr(4));
    if (command == "set maxspeed") return set_speed(words);
    if (command == "move abs" || command == "move rel") return move(command == "move rel", words);
    return "!BADCOMMAND";
  }

  std::string setting(const std::string& name) const {
    if (name == "pos") return whole((motor_.angle_deg() - zero_deg_) * steps_per_deg);
    if (name == "version") return settings_.old_firmware ? "6.28" : "7.33";
    // Manual of firmware 7, "device.id": that of firmware 6 was named deviceid.
    if (name == (settings_.old_firmware ? "deviceid" : "device.id")) return "50081";
    if (name == "system.serial") return "0";  // no device has it
    if (name == "limit.cycle.dist") return whole(steps_per_turn);
    if (name == "limit.min") return whole(settings_.min_deg * steps_per_deg);
    if (name == "limit.max") return whole(settings_.max_deg * steps_per_deg);
    if (name == "maxspeed") return std::to_string(max_speed_);
    // Manual, "accel": microsteps per second squared times 1.6384 over 10 000.
    if (name == "accel") return whole(settings_.motor.acceleration_deg_s2 * steps_per_deg * speed_units / 1e4);
    return "!BADCOMMAND";
  }

  static std::string whole(double value) { return std::to_string(std::llround(value)); }

  // Manual, "warnings": the number of flags, then the flags; "clear" clears those that do not last.
  std::string list_warnings(bool clear) {
    std::string text = two_digits(count_of(warnings_));
    for (const auto& flag : warnings_) text += " " + flag;
    if (clear) std::erase_if(warnings_, [](const std::string& flag) { return flag != "WR"; });
    return text;
  }

  void begin_motion() {
    // Manual, "NI": a motion was commanded while another went on; until one is commanded at rest.
    if (motor_.moving()) {
      warnings_.insert("NI");
    } else {
      warnings_.erase("NI");
    }
    homing_ = false;
  }

  // To the sensor, which is once a turn.
  std::string home() {
    begin_motion();
    homing_ = true;
    if (!motor_.moving()) {
      const double angle_deg = std::remainder(motor_.angle_deg(), 360.0);
      zero_deg_ += angle_deg - motor_.angle_deg();
      motor_.set_angle(angle_deg);
    }
    constexpr double homing_speed_deg_s = 60;
    go(0, homing_speed_deg_s);
    return "0";
  }

  std::string stop(void (SimMotor::*how)()) {
    if (motor_.moving()) (motor_.*how)();
    homing_ = false;
    return "0";
  }

  // FS: "stalling was detected and the axis has stopped itself" (manual, "Warning flags").
  void stall() {
    motor_.cut_power();
    warnings_.insert("FS");
    homing_ = false;
  }

  std::string set_speed(const std::vector<std::string>& words) {
    const auto value = words.size() == 1 ? parse_number(words[0]) : std::nullopt;
    if (!value || *value < 1 || *value > speed_bound || *value != std::floor(*value)) return "!BADDATA";
    max_speed_ = std::llround(*value);
    return "0";
  }

  // Manual, "move abs": within limit.min and limit.max, and not without a reference; whole microsteps. Library,
  // Axis.moveAbsolute: a speed may follow from firmware 7.25 on.
  std::string move(bool relative, const std::vector<std::string>& words) {
    const std::size_t most = settings_.old_firmware ? 1 : 2;
    if (words.empty() || words.size() > most || (!relative && warnings_.contains("WR"))) return "!BADDATA";
    std::vector<double> values;
    for (const auto& word : words) {
      const auto value = parse_number(word);
      if (!value || *value != std::floor(*value)) return "!BADDATA";
      values.push_back(*value);
    }
    const double speed = values.size() > 1 ? values[1] : static_cast<double>(max_speed_);
    const double from_deg = relative ? motor_.angle_deg() : zero_deg_;
    const double target_deg = from_deg + values[0] / steps_per_deg;
    const double position_deg = target_deg - zero_deg_;
    if (speed < 1 || speed > speed_bound) return "!BADDATA";
    if (position_deg < settings_.min_deg || position_deg > settings_.max_deg) return "!BADDATA";
    begin_motion();
    go(target_deg, speed / speed_units / steps_per_deg);
    return "0";
  }

  std::set<std::string> warnings_{"WR"};  // manual, "WR": no reference position after power-on
  double zero_deg_;                       // where its position is 0
  long long max_speed_ = 0;
  bool homing_ = false;
};

}  // namespace

std::unique_ptr<SimDevice> make_sim_zaber(const SimGcsSettings& settings, double now_s, SimLog log) {
  return std::make_unique<SimZaber>(settings, now_s, std::move(log));
}

}  // namespace vam::sim
