// SPDX-License-Identifier: GPL-3.0-or-later
#include "device/stage/private/line_link.hpp"

#include "base/text/printable.hpp"
#include "base/text/text.hpp"

namespace vam::device {

namespace {
constexpr std::size_t most_buffered = 65536;
}

void LineLink::drain() {
  buffer_.clear();
  while (!port_->read(1e-9).empty()) continue;
}

std::string LineLink::poll_line(double wait_s) {
  for (;;) {
    const std::size_t end = buffer_.find('\n');
    if (end != std::string::npos) {
      std::string line = buffer_.substr(0, end);
      buffer_.erase(0, end + 1);
      if (!line.empty() && line.back() == '\r') line.pop_back();
      if (!line.empty()) return line;
      continue;
    }
    const std::string bytes = port_->read(wait_s);
    if (bytes.empty()) return "";
    if (buffer_.size() + bytes.size() > most_buffered) throw malformed("?", buffer_);
    buffer_ += bytes;
  }
}

std::string LineLink::need_line(double wait_s) {
  std::string line = poll_line(wait_s);
  if (line.empty()) {
    throw Error{Fault::busy,
                port_->name() + ": no answer within " + format_number(wait_s) + " s; check power, cable and baud rate"};
  }
  return line;
}

Error LineLink::malformed(const std::string& question, const std::string& line) const {
  return {Fault::protocol, port_->name() + ": '" + question + "' was answered " + excerpt(line) +
                               ", not a reply of this controller; check the device and its baud rate"};
}

}  // namespace vam::device
