// SPDX-License-Identifier: GPL-3.0-or-later
// A simulated device at the far end of a serial line, on whatever clock its host has: a process with a pseudo-terminal
// (vam-sim stage) or the tool itself (sim:, and tests in virtual time).
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "base/text/json_fwd.hpp"
#include "device/os/clock.hpp"
#include "device/port/port.hpp"

namespace vam::sim {

class SimDevice {
 public:
  virtual ~SimDevice() = default;
  /// A user has opened the port, before his first byte.
  virtual void opened(double /*now_s*/) {}
  /// Bytes that arrive at now_s.
  virtual void receive(std::string_view bytes, double now_s) = 0;
  /// Lets time pass.
  virtual void advance(double now_s) = 0;
  /// When the next answer is due; nothing when there is none.
  [[nodiscard]] virtual std::optional<double> next_due_s() const = 0;
  /// The bytes due by now_s.
  virtual std::string take(double now_s) = 0;
  [[nodiscard]] virtual bool unplugged() const = 0;
};

/// What a simulator writes down about itself, to judge the tools by: {"t_monotonic_s": ..., "event": ..., ...}.
using SimLog = std::function<void(const Json&)>;

/// A port whose other end is a simulator in this process.
[[nodiscard]] std::unique_ptr<device::Port> make_sim_port(std::unique_ptr<SimDevice> device, device::Clock& clock);

}  // namespace vam::sim
