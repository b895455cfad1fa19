// SPDX-License-Identifier: GPL-3.0-or-later
// The event loop of a print: its tools run, and what the end of each means is decided by the state of the print.
#pragma once

#include <optional>
#include <vector>

#include "device/os/child.hpp"
#include "device/os/log_keeper.hpp"
#include "vam-print/run.hpp"
#include "vam-print/states.hpp"

namespace vam::print_tool {

// leftover.cpp: what a tool that was killed may have left on. Its guardian makes that safe and says so; where neither
// has a word left, vam-devices does it [devices §7].

/// It is stopped by a signal, and still a child of that process: its number may have gone to another one.
[[nodiscard]] bool is_stopped(const Child& tool, pid_t parent);
/// Kills it, and says why in its name.
void end_stopped(const Run& run, const Child& tool);

/// A tool that has ended drove a device, and neither it nor its guardian has said that all is safe, which is waited for
/// 0.4 s.
[[nodiscard]] bool is_left_on(const Run& run, const Child& tool);

/// vam-devices off, and a line that says of what: "project was", and what is not off.
void switch_off(const Run& run, const std::string& who);

/// A process that outlives this one, however that ends: it ends a tool that is stopped by a signal, twice in a second,
/// as the others would wait for it, the light on; and switches off what this process can no longer see to.
class Steward {
 public:
  /// To be made before this process has threads.
  Steward(const Run& run, const std::vector<Child>& tools);
  ~Steward();
  Steward(const Steward&) = delete;
  Steward& operator=(const Steward&) = delete;

 private:
  pid_t pid_ = -1;
};

class Drive {
 public:
  explicit Drive(Run& run) : run_(run) {}

  /// Starts the tools.
  void start();
  /// Until the print is over. Returns its exit status, and throws Ended and Interrupted; the tools may then still run.
  int watch();
  /// Dark, then still, whatever has happened; then what ran beside the print.
  void end_all();
  /// Nothing is added to the logs any more but to the events, which state the others.
  void keep_logs() { keeper_.reset(); }
  /// Until vam-status has read the end.
  void end_watching();
  /// The records are complete.
  void finish() { life_.reach(State::done); }

 private:
  void look();
  std::optional<int> take_end(Child tool);
  [[nodiscard]] Loss loss_of(const std::string& name) const;
  void order_end();
  void record(Child& tool, int status);
  [[noreturn]] void give_up(std::string name, bool alone);
  void hold(const std::string& name);
  void require_planned_end();
  [[noreturn]] void end_open_loop();
  [[nodiscard]] bool views_alone_failed() const;
  [[nodiscard]] bool others_run() const;
  [[nodiscard]] bool printed() const;
  [[nodiscard]] bool has_stop() const;
  [[nodiscard]] int complete();
  void end_renewal();
  [[nodiscard]] std::string reason_as_before() const;

  Run& run_;
  Life life_;
  std::vector<Child> tools_;
  std::optional<Child> renewal_, watcher_;
  std::optional<Steward> steward_;
  std::optional<device::LogKeeper> keeper_;
};

}  // namespace vam::print_tool
