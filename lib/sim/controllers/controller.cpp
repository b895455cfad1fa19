// SPDX-License-Identifier: GPL-3.0-or-later
#include "sim/controllers/private/controller.hpp"

#include <algorithm>
#include <utility>

#include "base/text/json.hpp"

namespace vam::sim {

namespace {
constexpr double late_s = 3;
}

SimController::SimController(const SimGcsSettings& settings, double now_s, SimLog log)
    : settings_(settings), motor_(settings.motor, now_s), now_s_(now_s), log_(std::move(log)), random_(settings.seed) {
  motor_.set_angle(settings.home_deg);
}

void SimController::receive(std::string_view bytes, double now_s) {
  advance(now_s);
  for (const char c : bytes) {
    if (silent()) return;
    on_byte(c);
  }
}

void SimController::advance(double now_s) {
  const bool moved = motor_.moving();
  while (motor_.moving() && next_log_s_ <= now_s) {
    now_s_ = std::max(next_log_s_, now_s_);
    motor_.advance(now_s_);
    note("angle", {{"angle_deg", motor_.angle_deg()}, {"speed_deg_s", motor_.speed_deg_s()}});
    next_log_s_ += settings_.log_period_s;
  }
  motor_.advance(now_s);
  now_s_ = std::max(now_s_, now_s);
  if (!moved || motor_.moving()) return;
  note("standing", {{"angle_deg", motor_.angle_deg()}});
  on_standing();
}

std::optional<double> SimController::next_due_s() const {
  return answers_.empty() ? std::nullopt : std::optional(answers_.begin()->first);
}

std::string SimController::take(double now_s) {
  std::string bytes;
  while (!answers_.empty() && answers_.begin()->first <= now_s) {
    bytes += answers_.begin()->second;
    answers_.erase(answers_.begin());
  }
  return bytes;
}

void SimController::note(const std::string& event, const Json& facts) {
  if (!log_) return;
  Json line{{"t_monotonic_s", now_s_}, {"event", event}};
  line.update(facts);
  log_(line);
}

double SimController::jitter() { return settings_.jitter_s * std::uniform_real_distribution<double>(0, 1)(random_); }

std::string SimController::record_command(const std::string& line, const std::string& command) {
  advance(now_s_ + settings_.latency_s / 2 + jitter());
  note("command", {{"text", line}});
  const int now = ++seen_[command];
  for (const auto& fault : settings_.faults) {
    if (fault.command != command || fault.occurrence != now) continue;
    note("fault", {{"kind", fault.kind}, {"command", command}});
    if (fault.kind == "power-loss" || fault.kind == "block") motor_.cut_power();
    if (fault.kind == "power-loss" || fault.kind == "unplug") unplugged_ = true;
    return fault.kind;
  }
  return "";
}

void SimController::answer(const std::string& text, double extra_s) {
  const double queued_until_s = answers_.empty() ? 0.0 : answers_.rbegin()->first;
  answers_.emplace(std::max(now_s_ + settings_.latency_s / 2 + jitter() + extra_s, queued_until_s), text);
}

void SimController::reply_with_fault(const std::string& fault, const std::string& text, const std::string& sender) {
  if (fault == "silent") return;
  if (fault == "garbage") {
    std::string noise = text;
    for (char& c : noise) c = static_cast<char>(random_() & 0x1FU);
    answer(noise + "\n");
  } else if (fault == "truncated") {
    answer(text.substr(0, text.size() / 2));
  } else if (fault == "wrong-sender") {
    answer("0 7 " + text);
  } else {
    answer(sender + text, fault == "late" ? late_s : 0.0);
  }
}

void SimController::go(double target_deg, double speed_deg_s) {
  motor_.set_speed(speed_deg_s);
  motor_.go_to(target_deg);
  next_log_s_ = now_s_;
  note("moving", {{"target_deg", target_deg}, {"speed_deg_s", speed_deg_s}});
}

}  // namespace vam::sim
