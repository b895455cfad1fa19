// SPDX-License-Identifier: GPL-3.0-or-later
// The event loop of a print: its tools run, and what the end of each means is decided by the state of the print.
#pragma once

#include <optional>
#include <vector>

#include "device/os/log_keeper.hpp"
#include "vam-print/child.hpp"
#include "vam-print/leftover.hpp"
#include "vam-print/run.hpp"
#include "vam-print/states.hpp"

namespace vam::print_tool {

class Drive {
 public:
  explicit Drive(Run& run) : run_(run) {}

  /// Until the last tool has ended, so that nobody takes the print for one that is over. Throws Error where another has
  /// the lock.
  void lock();
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
  void wait_for_an_end();
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
  int lock_ = -1;  // on the events, until the last tool has ended
  std::vector<Child> tools_;
  std::optional<Child> renewal_, watcher_;
  std::optional<Steward> steward_;
  std::optional<device::LogKeeper> keeper_;
};

}  // namespace vam::print_tool
