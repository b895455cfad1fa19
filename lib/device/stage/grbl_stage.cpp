// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <map>
#include <utility>

#include "base/error.hpp"
#include "base/text/json.hpp"
#include "base/text/printable.hpp"
#include "base/text/text.hpp"
#include "device/safety/stop_order.hpp"
#include "device/stage/private/line_link.hpp"
#include "device/stage/stage_backends.hpp"

namespace vam::device {

namespace {

constexpr double grbl_timeout_s = 0.2;
constexpr double wake_s = 2.0;  // opening the port resets most boards; their greeting takes a second
constexpr const char* alarm = "alarm state; its position is lost; run `vam-stage home`";
const std::string jog_cancel = "\x85";
const std::string soft_reset = "\x18";

class GrblStage final : public Stage {
 public:
  GrblStage(std::unique_ptr<Port> port, Clock& clock, int axis, Guardian* guardian, bool home_here)
      : link_(std::move(port)),
        port_(link_.port()),
        clock_(clock),
        axis_(axis),
        stop_order_(guardian),
        home_here_(home_here) {
    greet();
  }

  ~GrblStage() override {
    if (!stop_order_.standing()) return;
    try {
      port_.write(homing_ ? soft_reset : jog_cancel);
    } catch (...) {
      // The line is dead for us; the guardian keeps its order.
    }
  }

  // A board has no serial number; the name that its owner gave it ($I=name) must do.
  Json identify() override {
    return {
        {"maker", "GRBL"}, {"model", greeting_}, {"serial", given_name_}, {"firmware", version_}, {"axis", letter()}};
  }

  StageCaps caps() override {
    read_settings();
    StageCaps caps;
    const bool limited = settings_["$20"] != 0;
    const double travel_deg = limited ? settings_["$" + std::to_string(130 + axis_)] : 1e7;
    // GRBL's machine space lies below zero when limits are on.
    caps.min_deg = -travel_deg + offset_deg_;
    caps.max_deg = (limited ? 0 : travel_deg) + offset_deg_;
    caps.max_speed_deg_s = settings_["$" + std::to_string(110 + axis_)] / 60;
    caps.acceleration_deg_s2 = settings_["$" + std::to_string(120 + axis_)];
    return caps;
  }

  // Motions power the motor. "$X" would unlock a board that lost its position: only homing does, or home=here.
  void enable() override {}

  void start_homing() override {
    if (home_here_) return take_zero_here();
    watch();
    send("$H");
    homing_ = true;
    idle_since_s_.reset();
  }

  // "$H" answers ok only when it is done. Reports pause meanwhile, so the one that is requested at each look comes at
  // its end; a board that idles and has not answered ok is not going to.
  bool homed() override {
    if (!homing_) return true;
    stop_order_.beat();
    const std::string line = link_.poll_line(0.05);
    if (line.empty()) {
      if (idle_since_s_ && clock_.now_s() > *idle_since_s_ + grbl_timeout_s) {
        throw Error{Fault::busy, port_.name() + ": no answer to '$H' although the board is idle"};
      }
      port_.write("?");
      return false;
    }
    if (line.front() == '<') {
      if (state_of(line) == "Idle" && !idle_since_s_) idle_since_s_ = clock_.now_s();
      return false;
    }
    require_ok("$H", line);
    homing_ = false;
    referenced_ = true;
    offset_deg_ = -sample().angle_deg;
    stop_order_.withdraw();
    return true;
  }

  bool referenced() override { return referenced_; }

  bool keeps_zero() override { return !home_here_; }

  void set_speed(double deg_s) override { speed_deg_s_ = deg_s; }

  void set_angle(double angle_deg) override { offset_deg_ += angle_deg - sample().angle_deg; }

  void start_move(double angle_deg) override {
    watch();
    std::array<char, 80> text{};
    std::snprintf(text.data(), text.size(), "$J=G21 G53 G90 %s%.4f F%.3f", letter().c_str(), angle_deg - offset_deg_,
                  60 * speed_deg_s_);
    order(text.data());
  }

  StageSample sample() override {
    if (settings_.empty()) read_settings();  // whether it reports degrees
    StageSample now;
    link_.drain();
    now.t0_s = clock_.now_s();
    const std::string report = status();
    now.t1_s = clock_.now_s();
    now.angle_deg = position(report) + offset_deg_;
    if (const auto steps = settings_.find("$" + std::to_string(100 + axis_)); steps != settings_.end()) {
      now.step_deg = steps->second > 0 ? 1 / steps->second : 0;
    }
    return now;
  }

  bool moving() override {
    link_.drain();
    const std::string report = status();
    const std::string state = state_of(report);
    const bool alarmed = state == "Alarm";
    const bool lost = alarmed && std::exchange(referenced_, false);
    const bool moves = state != "Idle" && !alarmed;
    if (!moves) stop_order_.withdraw();
    if (lost) throw Error{Fault::protocol, port_.name() + ": " + alarm};
    return moves;
  }

  // Both stops are the cancelling of the jog, at the axis' acceleration: a reset would stop harder, but lose the
  // position. A search for the reference hears nothing else, and has no position yet; another process may have begun
  // one, or have left half a line.
  void stop(Stop how) override {
    stop_order_.beat();
    const bool reset = homing_ || (how == Stop::abrupt && !stop_order_.standing());
    port_.write(reset ? soft_reset : jog_cancel);
    if (reset) referenced_ = false;
    homing_ = false;
  }

  // Every order answers for itself.
  std::optional<std::string> fault() override {
    link_.drain();
    return state_of(status()) == "Alarm" ? std::optional<std::string>(alarm) : std::nullopt;
  }

 private:
  // A board without switches has no zero of its own: it counts from where it was switched on or reset.
  void take_zero_here() {
    read_settings();
    if (settings_["$22"] != 0) {
      throw Error{Fault::data, port_.name() + ": home=here: this board finds its switches ($22=" +
                                   format_number(settings_["$22"]) + "); omit home=here"};
    }
    if (state_of(status()) == "Alarm") order("$X");
    offset_deg_ -= sample().angle_deg;
    referenced_ = true;
  }

  std::string letter() const { return std::string(1, static_cast<char>('X' + axis_)); }

  void greet() {
    port_.write("\n");
    const double deadline_s = clock_.now_s() + wake_s;
    while (clock_.now_s() < deadline_s) {
      const std::string line = link_.poll_line(0.2);
      if (line.rfind("Grbl ", 0) == 0) {
        greeting_ = line.substr(0, line.find(" ["));
        break;
      }
      if (line == "ok") break;  // it was awake
    }
    link_.drain();
    send("$I");
    for (;;) {
      const std::string line = link_.need_line(grbl_timeout_s);
      if (line == "ok") break;
      if (line.rfind("[VER:", 0) == 0) read_version(line);
      if (line.rfind('[', 0) != 0) {
        throw Error{Fault::protocol, port_.name() + ": '$I' was answered " + excerpt(line) + "; this is not GRBL 1.1"};
      }
    }
  }

  // "[VER:1.1h.20190830:name]"
  void read_version(const std::string& line) {
    const std::size_t colon = line.find(':', 5);
    version_ = line.substr(5, std::min(colon, line.size() - 1) - 5);
    greeting_ = "Grbl " + version_;
    if (colon != std::string::npos) given_name_ = line.substr(colon + 1, line.find(']', colon) - colon - 1);
  }

  void read_settings() {
    send("$$");
    for (;;) {
      const std::string line = link_.need_line(grbl_timeout_s);
      if (line == "ok") break;
      const std::size_t equals = line.find('=');
      const auto value =
          equals == std::string::npos ? std::nullopt : parse_number(split(line.substr(equals + 1), ' ').front());
      if (line.front() != '$' || !value) throw link_.malformed("$$", line);
      settings_[line.substr(0, equals)] = *value;
    }
    if (settings_["$13"] == 0) return;
    throw Error{Fault::protocol,
                port_.name() + ": the board reports inches ($13=1), which are no degrees; send it $13=0"};
  }

  void send(const std::string& line) {
    link_.drain();
    port_.write(line + "\n");
  }

  static std::string meaning(const std::string& line) {
    if (line == "error:9") return " (alarm state); run `vam-stage home`";
    if (line == "error:5") return " (no homing switches, $22=0); add ?home=here to the device";
    return "";
  }

  void require_ok(const std::string& question, const std::string& line) const {
    if (line == "ok") return;
    if (line.rfind("error:", 0) == 0 || line.rfind("ALARM:", 0) == 0) {
      throw Error{Fault::protocol, port_.name() + ": '" + question + "' was refused with " + line + meaning(line)};
    }
    throw link_.malformed(question, line);
  }

  void order(const std::string& line) {
    send(line);
    std::string answer = link_.need_line(grbl_timeout_s);
    while (answer.front() == '[') answer = link_.need_line(grbl_timeout_s);  // "[MSG:Caution: Unlocked]"
    require_ok(line, answer);
    stop_order_.beat();
  }

  static std::string state_of(const std::string& report) { return report.substr(1, report.find_first_of("|>:") - 1); }

  // "<Jog|MPos:12.000,0.000,0.000|FS:600,0>"
  std::string status() {
    port_.write("?");
    std::string line = link_.need_line(grbl_timeout_s);
    while (line == "ok") line = link_.need_line(grbl_timeout_s);
    if (line.front() != '<' || line.back() != '>') throw link_.malformed("?", line);
    stop_order_.beat();
    return line;
  }

  double position(const std::string& report) const {
    const std::size_t begin = report.find("MPos:");
    const auto parts = begin == std::string::npos
                           ? std::vector<std::string>{}
                           : split(report.substr(begin + 5, report.find_first_of("|>", begin) - begin - 5), ',');
    const auto value = parts.size() == 3 ? parse_number(parts[axis_]) : std::nullopt;
    if (!value || !std::isfinite(*value)) {
      throw Error{Fault::protocol,
                  port_.name() + ": status '" + report.substr(0, 60) + "' has no machine position; set $10=1"};
    }
    return *value;
  }

  void watch() {
    // Cancels the jog; the LF ends half a line of the dead tool, and the second cancel what that may have started. The
    // reset stops whatever is left.
    const std::string bytes = jog_cancel + "\n" + jog_cancel + "!" + soft_reset;
    stop_order_.give(bytes, port_.handle());
  }

  LineLink link_;
  Port& port_;
  Clock& clock_;
  int axis_;
  StopOrder stop_order_;
  std::string greeting_ = "Grbl";
  std::string version_;
  std::string given_name_;
  std::map<std::string, double> settings_;
  double offset_deg_ = 0;
  double speed_deg_s_ = 10;
  bool home_here_;
  bool homing_ = false;
  bool referenced_ = false;  // a board does not tell whether it was homed, nor how far its zero is from the switch
  std::optional<double> idle_since_s_;
};

}  // namespace

std::unique_ptr<Stage> make_grbl_stage(std::unique_ptr<Port> port, Clock& clock, int axis, Guardian* guardian,
                                       bool home_here) {
  return std::make_unique<GrblStage>(std::move(port), clock, axis, guardian, home_here);
}

}  // namespace vam::device
