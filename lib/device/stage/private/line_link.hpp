// SPDX-License-Identifier: GPL-3.0-or-later
// Lines of text from a controller, each awaited for a bounded time.
#pragma once

#include <memory>
#include <string>

#include "base/error.hpp"
#include "device/port/port.hpp"

namespace vam::device {

class LineLink {
 public:
  explicit LineLink(std::unique_ptr<Port> port) : port_(std::move(port)) {}

  /// Throws away what has come unasked.
  void drain();
  /// The next line that is not empty, without CR and LF; "" when none is complete after wait_s without a byte. Throws
  /// Fault::protocol for 64 KiB without an end.
  [[nodiscard]] std::string poll_line(double wait_s);
  /// The same; throws Fault::busy when there is none.
  [[nodiscard]] std::string need_line(double wait_s);
  [[nodiscard]] Port& port() const { return *port_; }
  [[nodiscard]] Error malformed(const std::string& question, const std::string& line) const;

 private:
  std::unique_ptr<Port> port_;
  std::string buffer_;
};

}  // namespace vam::device
