// SPDX-License-Identifier: GPL-3.0-or-later
// Sources, named beside each behaviour: a number alone is a section of the maker's manual of the C-863.11 (PI MS249E);
// "errors" is the maker's list of codes, picontrollererrors.h, as public drivers have it (EPICS, epics-modules/motor,
// motorApp/PIGCS2Src).
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <utility>

#include "base/error.hpp"
#include "base/text/json.hpp"
#include "base/text/text.hpp"
#include "sim/controllers/controllers.hpp"
#include "sim/controllers/private/controller.hpp"

namespace vam::sim {

namespace {

const char* const help_lines[] = {"#5 - Request motion status",
                                  "#7 - Request controller ready",
                                  "#24 - Stop all motion",
                                  "*IDN? - Get identity",
                                  "ACC - Set acceleration",
                                  "ACC? - Get acceleration",
                                  "CSV? - Get syntax version",
                                  "ERR? - Get error number",
                                  "FRF - Reference move",
                                  "FRF? - Get reference result",
                                  "HLP? - Get help",
                                  "HLT - Halt smoothly",
                                  "MOV - Move absolute",
                                  "MOV? - Get target",
                                  "MVR - Move relative",
                                  "ONT? - Get on-target state",
                                  "POS - Set position",
                                  "POS? - Get position",
                                  "PUN? - Get position unit",
                                  "RON - Set reference mode",
                                  "RON? - Get reference mode",
                                  "SAI? - Get axis names",
                                  "SPA? - Get parameter",
                                  "STP - Stop all motion",
                                  "SVO - Set servo",
                                  "SVO? - Get servo",
                                  "TMN? - Get lower limit",
                                  "TMX? - Get upper limit",
                                  "VEL - Set velocity",
                                  "VEL? - Get velocity"};

// Of "errors", PI_CNTR_...
constexpr int unknown_command = 2;          // UNKNOWN_COMMAND
constexpr int no_reference_or_servo = 5;    // MOVE_WITHOUT_REF_OR_NO_SERVO
constexpr int beyond_limits = 7;            // POS_OUT_OF_LIMITS
constexpr int too_fast = 8;                 // VEL_OUT_OF_LIMITS
constexpr int stopped = 10;                 // STOP: by command
constexpr int no_such_axis = 15;            // INVALID_AXIS_IDENTIFIER
constexpr int parameter_out_of_range = 17;  // PARAM_OUT_OF_RANGE
constexpr int wrong_number = 24;            // PARAM_NR: of parameters
constexpr int no_real_number = 25;          // INVALID_REAL_NR
constexpr int reference_disabled = 50;      // REF_WITH_REF_DISABLED
constexpr int unknown_parameter = 54;       // UNKNOWN_PARAMETER
constexpr int reference_mode_is_on = 88;    // REF_MODE_IS_ON
constexpr int axis_in_motion = 93;          // CMD_NOT_ALLOWED_WHILE_AXIS_IN_MOTION

std::string decimal(double value, const char* format = "%.5f") {
  std::array<char, 40> text{};
  std::snprintf(text.data(), text.size(), format, value);
  return text.data();
}

class SimGcs final : public SimController {
 public:
  using SimController::SimController;

 private:
  // 8.2 and 8.3: an address may precede single bytes, too; they need no LF.
  void on_byte(char c) override {
    if (c == 5 || c == 7 || c == 24) {
      const bool for_someone = line_.find_first_not_of("0123456789 ") == std::string::npos;
      handle((for_someone ? std::exchange(line_, "") : "") + "#" + std::to_string(static_cast<int>(c)));
    } else if (c == '\n') {
      handle(std::exchange(line_, ""));
    } else {
      line_ += c;
    }
  }

  void on_standing() override {
    if (homing_) referenced_ = motor_.target_deg() == 0;
    if (referenced_) unknown_deg_ = 0;
    homing_ = false;
  }

  // Takes "1 POS? 1" or "POS? 1"; other controllers' commands are not for us. Without an address a command, single
  // bytes included, is for controller 1; a sender is named only where an address was given (8.3 "Target and sender
  // address").
  void handle(const std::string& line) {
    auto words = split(line, ' ');
    std::erase(words, "");
    if (words.empty()) return;
    addressed_ = !words.front().empty() && words.front().find_first_not_of("0123456789") == std::string::npos;
    if (addressed_) {
      if (words.front() != std::to_string(settings_.address)) return;
      words.erase(words.begin());
      if (words.empty()) return;
    } else if (settings_.address != 1) {
      return;
    }
    const std::string command = words.front();
    words.erase(words.begin());
    const std::string fault = record_command(line, command);
    if (silent()) return;
    if (fault == "error") {
      error_ = parameter_out_of_range;
      return;
    }
    const std::string text = reply(command, words);
    if (text.empty()) return;
    reply_with_fault(fault, text, addressed_ ? "0 " + std::to_string(settings_.address) + " " : "");
  }

  // The whole answer with its LF; empty for an order (8.4: only questions are answered). #5: a bit for each axis that
  // moves, hexadecimal; #7: B1 or B0; ERR? clears; #24 and STP stop abruptly and set error 10.
  std::string reply(const std::string& command, const std::vector<std::string>& words) {
    if (command == "#5") return decimal(motor_.moving() ? 1 : 0, "%.0f") + "\n";
    if (command == "#7") return std::string(1, homing_ ? '\xB0' : '\xB1') + "\n";
    if (command == "*IDN?") return "VAM tools (simulated), C-863.11, 0116012345, 1.2.1.0\n";
    if (command == "CSV?") return "2.0\n";
    if (command == "HLP?") return help();
    if (command == "SAI?") return "1\n";
    if (command == "ERR?") return std::to_string(std::exchange(error_, 0)) + "\n";
    if (command == "#24" || command == "STP") return stop(&SimMotor::brake);
    if (words.empty() || words.front() != "1") return refuse(words.empty() ? wrong_number : no_such_axis);
    if (command.back() == '?') {
      const std::string text = query(command, words);
      return text.empty() ? "" : words.front() + text;
    }
    return execute(command, words);
  }

  // 8.4: of an answer of several lines all but the last end in a space.
  static std::string help() {
    std::string text;
    for (const char* line : help_lines) text += std::string(text.empty() ? "" : " \n") + line;
    return text + "\n";
  }

  std::string stop(void (SimMotor::*how)()) {
    if (motor_.moving()) (motor_.*how)();
    homing_ = false;
    error_ = stopped;
    return "";
  }

  std::string refuse(int code) {
    error_ = code;
    return "";
  }

  std::string query(const std::string& command, const std::vector<std::string>& words) {
    if (command == "POS?") return "=" + decimal(motor_.angle_deg() - unknown_deg_) + "\n";
    if (command == "MOV?") return "=" + decimal(motor_.target_deg() - unknown_deg_) + "\n";
    if (command == "ONT?") return motor_.moving() ? "=0\n" : "=1\n";
    if (command == "SVO?") return servo_ ? "=1\n" : "=0\n";
    if (command == "FRF?") return referenced_ ? "=1\n" : "=0\n";
    if (command == "RON?") return reference_mode_ ? "=1\n" : "=0\n";
    if (command == "VEL?") return "=" + decimal(speed_deg_s_) + "\n";
    if (command == "ACC?") return "=" + decimal(settings_.motor.acceleration_deg_s2) + "\n";
    if (command == "TMN?") return "=" + decimal(settings_.min_deg) + "\n";
    if (command == "TMX?") return "=" + decimal(settings_.max_deg) + "\n";
    if (command == "PUN?") return "=DEG\n";
    if (command == "SPA?" && words.size() == 2 && words[1] == "0xA") {
      return " 0xA=" + decimal(settings_.max_speed_deg_s) + "\n";
    }
    return refuse(command == "SPA?" ? unknown_parameter : unknown_command);
  }

  // RON 0 lets POS set the position, which counts as a reference (8.4, "POS", "RON"); never in motion.
  std::string execute(const std::string& command, const std::vector<std::string>& words) {
    if (command == "HLT") return stop(&SimMotor::halt);
    if (command == "FRF") return reference();
    if (words.size() != 2) return refuse(wrong_number);
    const auto number = parse_number(words[1]);
    if (!number) return refuse(no_real_number);
    const double value = *number;
    if (command == "MOV") return travel(value);
    if (command == "MVR") return travel(motor_.target_deg() + value);
    if (command == "SVO") {
      servo_ = value != 0;
      if (!servo_ && motor_.moving()) motor_.cut_power();
    } else if (command == "RON") {
      reference_mode_ = value != 0;
    } else if (command == "POS") {
      if (reference_mode_) return refuse(reference_mode_is_on);
      if (motor_.moving()) return refuse(axis_in_motion);
      motor_.set_angle(value);
      referenced_ = true;
      unknown_deg_ = 0;
      note("zeroed", {{"angle_deg", value}});
    } else if (command == "VEL") {
      if (value < 0 || value > settings_.max_speed_deg_s) return refuse(too_fast);
      speed_deg_s_ = value;
      motor_.set_speed(value);
    } else {
      return refuse(unknown_command);
    }
    return "";
  }

  std::string reference() {
    if (!reference_mode_) return refuse(reference_disabled);
    if (!servo_) return refuse(no_reference_or_servo);
    homing_ = true;
    constexpr double homing_speed_deg_s = 30;
    go(0, homing_speed_deg_s);
    return "";
  }

  // 8.4, "MOV": servo on, referenced, inside the limits.
  std::string travel(double target_deg) {
    if (!servo_ || !referenced_ || homing_) return refuse(no_reference_or_servo);
    if (target_deg < settings_.min_deg || target_deg > settings_.max_deg) return refuse(beyond_limits);
    go(target_deg, speed_deg_s_);
    return "";
  }

  int error_ = 0;
  double speed_deg_s_ = 10;
  bool addressed_ = false;
  bool servo_ = false;
  bool referenced_ = settings_.referenced;
  double unknown_deg_ = referenced_ ? 0 : settings_.home_deg;  // a stage without reference counts from its power-on
  bool reference_mode_ = true;
  bool homing_ = false;
};

}  // namespace

SimFault parse_sim_fault(const std::string& text) {
  static const std::vector<std::string> kinds{"garbage", "truncated", "late",       "silent", "wrong-sender",
                                              "error",   "unplug",    "power-loss", "block",  "stall"};
  const std::size_t at = text.find('@');
  SimFault fault{text.substr(0, at), at == std::string::npos ? "" : text.substr(at + 1), 1};
  const std::size_t colon = fault.command.find(':');
  bool good = std::find(kinds.begin(), kinds.end(), fault.kind) != kinds.end();
  if (colon != std::string::npos) {
    const auto number = parse_number(fault.command.substr(colon + 1));
    good = good && number && *number >= 1 && *number <= 1e6 && *number == std::floor(*number);
    if (good) fault.occurrence = static_cast<int>(*number);
    fault.command.resize(colon);
  }
  if (!good || fault.command.empty()) {
    throw Error{Fault::usage,
                "fault '" + text + "': expected KIND@COMMAND[:N], e.g. truncated@POS?:3; kinds: " + join(kinds, ", ")};
  }
  return fault;
}

std::unique_ptr<SimDevice> make_sim_gcs(const SimGcsSettings& settings, double now_s, SimLog log) {
  return std::make_unique<SimGcs>(settings, now_s, std::move(log));
}

}  // namespace vam::sim
