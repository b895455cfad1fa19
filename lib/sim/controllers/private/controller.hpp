// SPDX-License-Identifier: GPL-3.0-or-later
// What simulated controllers share: a motor, a line with latency, a log of the truth, and faults.
#pragma once

#include <map>
#include <random>
#include <string>

#include "sim/controllers/controllers.hpp"

namespace vam::sim {

class SimController : public SimDevice {
 public:
  SimController(const SimGcsSettings& settings, double now_s, SimLog log);
  void receive(std::string_view bytes, double now_s) final;
  void advance(double now_s) override;
  [[nodiscard]] std::optional<double> next_due_s() const override;
  std::string take(double now_s) override;
  [[nodiscard]] bool unplugged() const override { return unplugged_; }

 protected:
  /// A byte has come; none after the cable was pulled.
  virtual void on_byte(char c) = 0;
  /// The stage has come to rest.
  virtual void on_standing() {}
  void note(const std::string& event, const Json& facts);
  /// A command has arrived: lets the first half of the latency pass, logs it, and returns the fault that it has coming
  /// ("" for none). unplug, power-loss and block have happened by then; after the first two nothing may be answered.
  std::string record_command(const std::string& line, const std::string& command);
  /// Puts bytes on the line, the second half of the latency later.
  void answer(const std::string& text, double extra_s = 0);
  /// The same, spoilt; sender is what a right answer of a daisy chain begins with.
  void reply_with_fault(const std::string& fault, const std::string& text, const std::string& sender);
  void go(double target_deg, double speed_deg_s);
  [[nodiscard]] bool silent() const { return unplugged_; }

  SimGcsSettings settings_;
  SimMotor motor_;
  std::string line_;  // what has come of a command
  double now_s_;

 private:
  double jitter();
  SimLog log_;
  double next_log_s_ = 0;
  std::mt19937_64 random_;
  std::multimap<double, std::string> answers_;
  std::map<std::string, int> seen_;
  bool unplugged_ = false;
};

}  // namespace vam::sim
