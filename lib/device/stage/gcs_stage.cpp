// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cctype>
#include <utility>

#include "base/log/log.hpp"
#include "base/text/figure_text.hpp"
#include "base/text/json.hpp"
#include "base/text/text.hpp"
#include "device/port/serial_port.hpp"
#include "device/safety/stop_order.hpp"
#include "device/stage/stage_backends.hpp"

namespace vam::device {

namespace {

constexpr int stopped_by_command = 10;

// #24 stops at once; the LF ends half a command that the dead tool may have left in the controller, which could be a
// motion, so STP and #24 follow. With an address half a command comes first: what follows it would be a part of it.
std::string stop_bytes(const GcsSettings& settings) {
  const std::string now = addressed("\x18", settings);
  return settings.address ? "\n" + now + addressed("STP\n", settings) + now : now + "\nSTP\n" + now;
}

class GcsStage final : public Stage {
 public:
  GcsStage(std::unique_ptr<Port> port, Clock& clock, GcsSettings settings, std::string axis, Guardian* guardian)
      : link_(std::move(port), clock, settings), axis_(std::move(axis)), stop_order_(guardian) {}

  ~GcsStage() override {
    if (!stop_order_.standing()) return;
    try {
      link_.halt_now();
    } catch (...) {
      // The line is dead for us. The order stays with the guardian, which acts when the tool ends.
    }
  }

  Json identify() override {
    const std::string line = link_.ask("*IDN?").lines.front();
    const auto parts = split(line, ',');
    if (parts.size() < 4) throw link_.malformed("*IDN?", line, "not 'maker, model, serial, firmware'");
    Json about{{"maker", trimmed(parts[0])}, {"model", trimmed(parts[1])}};
    about["serial"] = trimmed(parts[2]);
    about["firmware"] = trimmed(parts[3]);
    about["axis"] = axis_;
    about["unit"] = unit();
    stop_order_.beat();
    return about;
  }

  StageCaps caps() override {
    StageCaps caps;
    caps.min_deg = value("TMN?");
    caps.max_deg = value("TMX?");
    if (has("ACC?")) caps.acceleration_deg_s2 = value("ACC?");
    if (has("SPA?")) caps.max_speed_deg_s = link_.ask_number("SPA? " + axis_ + " 0xA");  // maximum closed-loop velocity
    stop_order_.beat();
    return caps;
  }

  void enable() override {
    const std::string wrong = unit();
    if (!wrong.empty() && wrong.rfind("deg", 0) != 0) {
      throw Error{Fault::data, link_.port().name() + ": unit of the axis is " + wrong +
                                   ", not degrees; load the parameters of a rotation stage into the controller"};
    }
    order("SVO " + axis_ + " 1");
  }

  void start_homing() override {
    order("RON " + axis_ + " 1");
    watch();
    order("FRF " + axis_);
  }

  bool homed() override {
    const bool ready = link_.ready();
    stop_order_.beat();
    if (!ready) return false;
    if (const auto problem = fault())
      throw Error{Fault::protocol, link_.port().name() + ": homing failed with error " + *problem};
    if (value("FRF?") != 1) throw Error{Fault::protocol, link_.port().name() + ": homing ended without a reference"};
    stop_order_.withdraw();
    return true;
  }

  bool referenced() override {
    const bool found = value("FRF?") == 1;
    stop_order_.beat();
    return found;
  }

  void set_speed(double deg_s) override { order("VEL " + axis_ + " " + fixed_number(deg_s, 6)); }

  // The controller takes a set position for a reference, too: spin() asks for the reference before.
  void set_angle(double angle_deg) override {
    order("RON " + axis_ + " 0");
    order("POS " + axis_ + " " + fixed_number(angle_deg, 6));
  }

  void start_move(double angle_deg) override {
    watch();
    order("MOV " + axis_ + " " + fixed_number(angle_deg, 6));
  }

  StageSample sample() override {
    StageSample now;
    now.angle_deg = link_.ask_number("POS? " + axis_, &now.t0_s, &now.t1_s);
    stop_order_.beat();
    return now;
  }

  bool moving() override {
    const bool moves = (link_.motion_bits() & 1U) != 0;
    stop_order_.beat();
    if (!moves) stop_order_.withdraw();
    return moves;
  }

  void stop(Stop how) override {
    // What follows is bounded; the guardian shall not cut it short after an answer that did not come.
    stop_order_.beat();
    if (how == Stop::smooth) {
      link_.order("HLT " + axis_, stopped_by_command);
    } else {
      link_.halt_now();
      const int code = link_.take_error();
      if (code != 0 && code != stopped_by_command) {
        throw Error{Fault::protocol, link_.port().name() + ": stopped with error " + gcs_error_text(code)};
      }
    }
    stop_order_.beat();
  }

  std::optional<std::string> fault() override {
    const int code = link_.take_error();
    stop_order_.beat();
    return code == 0 ? std::nullopt : std::optional(gcs_error_text(code));
  }

 private:
  double value(const std::string& question) { return link_.ask_number(question + " " + axis_); }

  void order(const std::string& text) {
    link_.order(text);
    stop_order_.beat();
  }

  // HLP? lists the commands, one "NAME - what" a line; queried once.
  bool has(const std::string& command) {
    if (commands_.empty()) {
      for (const auto& line : link_.ask("HLP?").lines) commands_ += "\n" + line;
    }
    return commands_.find("\n" + command + " ") != std::string::npos;
  }

  std::string unit() {
    if (!has("PUN?")) return "";
    const std::string line = link_.ask("PUN? " + axis_).lines.front();
    std::string name = trimmed(line.substr(line.find('=') + 1));  // "deg" or "DEG", as the parameters were loaded
    std::transform(name.begin(), name.end(), name.begin(), [](unsigned char c) { return std::tolower(c); });
    return name;
  }

  void watch() { stop_order_.give(stop_bytes(link_.settings()), link_.port().handle()); }

  GcsLink link_;
  std::string axis_;
  StopOrder stop_order_;
  std::string commands_;
};

}  // namespace

std::unique_ptr<Stage> make_gcs_stage(std::unique_ptr<Port> port, Clock& clock, GcsSettings settings,
                                      const std::string& axis, Guardian* guardian) {
  return std::make_unique<GcsStage>(std::move(port), clock, settings, axis, guardian);
}

void require_axis(GcsLink& link, const std::string& axis) {
  std::vector<std::string> axes;
  try {
    for (const auto& line : link.ask("SAI?").lines) axes.push_back(trimmed(line));
  } catch (const Error& error) {
    if (error.fault == Fault::busy) return;  // it does not know the question
    throw;
  }
  if (std::find(axes.begin(), axes.end(), axis) != axes.end()) return;
  throw Error{Fault::usage, link.port().name() + ": no axis " + axis + "; the controller has " + join(axes, ", ")};
}

std::unique_ptr<Port> find_gcs(const std::string& path, std::optional<int> baud, Clock& clock,
                               const GcsSettings& settings) {
  if (baud) return open_serial(path, *baud);
  for (const int rate : {115200, 38400, 19200, 9600}) {
    GcsLink link(open_serial(path, rate), clock, settings);
    // The first question ends what a wrong rate left in the controller's buffer, so only the second one counts.
    for (int attempt = 0; attempt < 2; ++attempt) {
      try {
        if (split(link.ask("*IDN?").lines.front(), ',').size() < 4) continue;
        if (link.take_error() >= 0) return link.take_port();
      } catch (const Error& error) {
        if (error.fault == Fault::absent) throw;
      }
    }
  }
  throw Error{Fault::busy, path +
                               ": no answer to *IDN? at 115200, 38400, 19200 or 9600 baud; check power, cable and "
                               "that a PI controller is at the other end"};
}

}  // namespace vam::device
