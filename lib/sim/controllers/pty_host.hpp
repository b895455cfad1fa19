// SPDX-License-Identifier: GPL-3.0-or-later
// A simulated device behind a pseudo-terminal: to the tools it is a serial port.
#pragma once

#include <optional>
#include <string>

#include "sim/controllers/device.hpp"

namespace vam::sim {

/// The master's end of a new pseudo-terminal, raw from the start.
class Pty {
 public:
  Pty();  // throws Fault::absent when the system has none left
  ~Pty();
  Pty(const Pty&) = delete;
  Pty& operator=(const Pty&) = delete;
  [[nodiscard]] int master() const { return master_; }
  [[nodiscard]] const std::string& path() const { return path_; }
  /// What the tool at the other end has set.
  [[nodiscard]] int baud() const;
  /// Whether a user has opened it since the last call.
  [[nodiscard]] bool take_opened();
  void unplug();

 private:
  int master_ = -1;
  int opens_ = -1;  // inotify's
  int slave_ = -1;  // keeps the terminal alive between its users
  std::string path_;
};

/// Serves the device until a signal. At another baud rate than `baud` (when given) bytes arrive as garbage both ways.
void serve(Pty& pty, SimDevice& device, std::optional<int> baud);

}  // namespace vam::sim
