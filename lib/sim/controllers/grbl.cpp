// SPDX-License-Identifier: GPL-3.0-or-later
// Sources, named beside each behaviour: "Interface", "Jogging", "Commands" and "Configuration" are the pages of GRBL
// 1.1's wiki (github.com/gnea/grbl/wiki), "limits.c" is its own source.
#include <algorithm>
#include <array>
#include <cstdio>
#include <utility>

#include "base/text/text.hpp"
#include "sim/controllers/controllers.hpp"
#include "sim/controllers/private/controller.hpp"

namespace vam::sim {

namespace {

class SimGrbl final : public SimController {
 public:
  using SimController::SimController;

  // Interface: a board that the opened port resets stops, has lost its position, and greets.
  void opened(double now_s) override {
    advance(now_s);
    if (!settings_.reset_at_open) return;
    if (motor_.moving()) motor_.brake();
    homing_ = alarm_ = greeted_ = false;
    line_.clear();
  }

 private:
  // Commands, "Real-Time Commands": single bytes, acted on at once, anywhere in a line, without an "ok".
  void on_byte(char c) override {
    if (c == '?') {
      asked_while_homing_ = homing_;  // reports pause: limits.c, limits_go_home, looks at reset and door only
      if (!homing_) reply("?", "?", status());
    } else if (c == '\x85') {
      cancel();
    } else if (c == '\x18') {
      reset();
    } else if (c == '\n') {
      handle(std::exchange(line_, ""));
    } else if (c != '!' && c != '~' && c != '\r') {
      line_ += c;
    }
  }

  void on_standing() override {
    if (!homing_) return;
    homing_ = alarm_ = false;  // Commands, "$H": it also unlocks
    unknown_deg_ = 0;
    if (std::exchange(asked_while_homing_, false)) answer(status());
    reply_with_fault(homing_fault_, homing_fault_ == "error" ? "ALARM:9\r\n" : "ok\r\n", "");
  }

  void reply(const std::string& line, const std::string& command, const std::string& text) {
    const std::string fault = record_command(line, command);
    if (silent()) return;
    reply_with_fault(fault, fault == "error" ? "error:9\r\n" : text, "");
  }

  // Commands, "0x85": decelerates and leaves the state of jogging; without effect in another one.
  void cancel() {
    record_command("0x85", "0x85");
    if (motor_.moving() && !homing_) motor_.halt();
  }

  // Commands, "0x18": during motion it is an alarm, since the position may be lost; the greeting follows.
  void reset() {
    record_command("0x18", "0x18");
    alarm_ = motor_.moving();
    if (motor_.moving()) motor_.brake();
    homing_ = false;
    line_.clear();
    answer("\r\nGrbl 1.1h ['$' for help]\r\n");
  }

  // Interface, status reports: with $10=1 the position is the machine's, in units, the feed per minute.
  std::string status() const {
    const char* state = alarm_ ? "Alarm" : homing_ ? "Home" : motor_.moving() ? "Jog" : "Idle";
    std::array<char, 120> text{};
    std::snprintf(text.data(), text.size(), "<%s|MPos:%.3f,0.000,0.000|FS:%.0f,0>\r\n", state,
                  (motor_.angle_deg() - unknown_deg_) / (settings_.inches ? 25.4 : 1), 60 * motor_.speed_deg_s());
    return text.data();
  }

  // Configuration: rates are in units per minute ($110), accelerations in units per second squared ($120).
  std::string settings_text() const {
    std::array<char, 240> text{};
    std::snprintf(text.data(), text.size(),
                  "$10=1\r\n$13=%d\r\n$20=%d\r\n$22=%d\r\n$110=%.3f\r\n$120=%.3f\r\n$130=%.3f\r\nok\r\n",
                  settings_.inches ? 1 : 0, 0, settings_.no_switches ? 0 : 1, 60 * settings_.max_speed_deg_s,
                  settings_.motor.acceleration_deg_s2, settings_.max_deg);
    return text.data();
  }

  void handle(const std::string& line) {
    if (settings_.reset_at_open && !std::exchange(greeted_, true)) {
      unknown_deg_ = motor_.angle_deg();
      return answer("\r\nGrbl 1.1h ['$' for help]\r\n");
    }
    if (line.empty()) return answer("ok\r\n");
    const std::string command = line.substr(0, line.rfind("$J=", 0) == 0 ? 2 : line.size());
    if (command == "$I")
      return reply(line, command, "[VER:1.1h.20190830:stage 3 (simulated)]\r\n[OPT:V,15,128]\r\nok\r\n");
    if (command == "$$") return reply(line, command, settings_text());
    if (command == "$X") {
      alarm_ = false;
      return reply(line, command, "[MSG:Caution: Unlocked]\r\nok\r\n");
    }
    if (command == "$H") {
      // Configuration, $22, and Interface, error 5: "Homing cycle is not enabled via settings."
      if (settings_.no_switches) return reply(line, command, "error:5\r\n");
      homing_fault_ = record_command(line, command);
      if (silent()) return;
      homing_ = true;
      constexpr double homing_speed_deg_s = 30;
      return go(0, homing_speed_deg_s);
    }
    if (command == "$J") return jog(line);
    reply(line, command, "error:20\r\n");
  }

  // "$J=G53 G90 X360.0000 F600.000". Jogging: error 15 beyond the travel, 9 in alarm or while it homes; the feed is
  // held to the largest rate.
  void jog(const std::string& line) {
    std::optional<double> target_deg;
    std::optional<double> feed;
    for (const auto& word : split(line.substr(3), ' ')) {
      if (word.front() == 'X') target_deg = parse_number(word.substr(1));
      if (word.front() == 'F') feed = parse_number(word.substr(1));
    }
    const bool good = target_deg && feed && *feed > 0 && !alarm_ && !homing_;
    const bool inside = good && *target_deg >= settings_.min_deg && *target_deg <= settings_.max_deg;
    reply(line, "$J", inside ? "ok\r\n" : good ? "error:15\r\n" : "error:9\r\n");
    if (inside && !silent()) go(*target_deg + unknown_deg_, std::min(*feed / 60, settings_.max_speed_deg_s));
  }

  double unknown_deg_ = settings_.home_deg;  // a board that was not homed counts from where it was switched on
  bool homing_ = false;
  bool greeted_ = false;
  bool asked_while_homing_ = false;
  std::string homing_fault_;
  bool alarm_ = false;
};

}  // namespace

std::unique_ptr<SimDevice> make_sim_grbl(const SimGcsSettings& settings, double now_s, SimLog log) {
  return std::make_unique<SimGrbl>(settings, now_s, std::move(log));
}

}  // namespace vam::sim
