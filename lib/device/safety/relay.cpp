// SPDX-License-Identifier: GPL-3.0-or-later
#include "device/safety/relay.hpp"

#include <cmath>
#include <utility>

#include "base/error.hpp"
#include "base/text/json.hpp"
#include "base/text/text.hpp"
#include "device/os/identity.hpp"
#include "device/safety/guardian_actions.hpp"

namespace vam::device {

namespace {

constexpr double boot_s = 3;  // of a board that its port resets
constexpr double patience_s = 0.2;
constexpr double period_s = 0.05;  // of heartbeats
constexpr double shortest_limit_s = 0.15;
constexpr double longest_limit_s = 1;

// "vam-relay 1 300": kind, version, milliseconds without a heartbeat, then remarks.
std::optional<double> limit_of(const std::string& line) {
  const auto words = split(line, ' ');
  if (words.size() < 3 || words[0] != "vam-relay" || words[1] != "1") return std::nullopt;
  const auto milliseconds = parse_number(words[2]);
  return milliseconds ? std::optional(*milliseconds / 1000) : std::nullopt;
}

}  // namespace

Relay::Relay(std::unique_ptr<Port> port, Clock& clock, Guardian* guardian)
    : port_(std::move(port)), clock_(clock), guardian_(guardian) {
  const double deadline_s = clock_.now_s() + boot_s;
  std::optional<double> limit_s;
  while (!limit_s) {
    port_->write("?");
    const std::string line = answer(patience_s);
    limit_s = limit_of(line);
    simulated_ = line.ends_with(" simulated");
    if (!line.empty() && !limit_s) {
      throw Error{Fault::protocol, port_->name() + ": reply '" + line.substr(0, 40) + "' is not that of a relay"};
    }
    if (!limit_s && clock_.now_s() > deadline_s) {
      throw Error{Fault::busy, port_->name() + ": no reply from the relay within " + format_number(boot_s) +
                                   " s; the light stays off without it"};
    }
  }
  limit_s_ = *limit_s;
  if (limit_s_ < shortest_limit_s || limit_s_ > longest_limit_s) {
    throw Error{Fault::protocol, port_->name() + ": time limit of the relay is " + format_number(1000 * limit_s_) +
                                     " ms; set 150 to 1000 ms in its firmware"};
  }
}

Relay::~Relay() {
  try {
    open();
  } catch (...) {
    // It opens by itself when no heartbeat comes.
  }
}

Json Relay::identify() const {
  return with_mark(
      {{"maker", "VAM tools"}, {"model", simulated_ ? "relay (simulated)" : "relay"}, {"limit_ms", 1000 * limit_s_}});
}

std::string Relay::answer(double timeout_s) {
  const double deadline_s = clock_.now_s() + timeout_s;
  for (;;) {
    const std::size_t end = buffer_.find('\n');
    if (end != std::string::npos) {
      std::string line = trimmed(buffer_.substr(0, end));
      buffer_.erase(0, end + 1);
      return line;
    }
    const double left_s = deadline_s - clock_.now_s();
    const std::string bytes = port_->read(left_s > 0 ? left_s : 1e-9);
    buffer_ += bytes;
    if (bytes.empty() || buffer_.size() > 4096) return "";
  }
}

void Relay::close() {
  if (guardian_ != nullptr && port_->handle() >= 0 && !action_) {
    action_ = guardian_->add({{"do", "write"}, {"order", 0}, {"name", "relay"}, {"hex", to_hex("O")}}, port_->handle());
  }
  while (!answer(1e-9).empty()) continue;
  port_->write("A");
  closed_ = true;
  sent_s_ = answered_s_ = clock_.now_s();
  if (answer(patience_s) != "closed") {
    throw Error{Fault::busy, port_->name() + ": relay does not close; the light stays off without it"};
  }
}

void Relay::beat() {
  const double now_s = clock_.now_s();
  if (!closed_ || now_s < sent_s_ + period_s) return;
  for (std::string line = answer(1e-9); !line.empty(); line = answer(1e-9)) {
    if (line != "closed") {
      throw Error{Fault::protocol, port_->name() + ": relay has switched off the lamp: no heartbeat received for " +
                                       format_number(1000 * limit_s_) + " ms, or it was commanded to open"};
    }
    answered_s_ = now_s;
  }
  if (now_s - answered_s_ > limit_s_ + (now_s - sent_s_)) {
    throw Error{Fault::busy, port_->name() + ": no reply from the relay for " +
                                 format_number(std::round(1000 * (now_s - answered_s_))) + " ms; check its cable"};
  }
  port_->write("H");
  sent_s_ = now_s;
}

void Relay::cut() {
  if (!std::exchange(closed_, false)) return;
  opening_ = true;
  port_->write("O");
}

void Relay::open() {
  cut();
  if (!std::exchange(opening_, false)) return;
  for (std::string line = answer(patience_s); line != "open"; line = answer(patience_s)) {
    if (line.empty()) throw Error{Fault::busy, port_->name() + ": relay has not confirmed that it opened"};
  }
  if (action_) guardian_->forget(*action_);
  action_.reset();
}

void Relay::force_open() {
  closed_ = true;
  open();
}

}  // namespace vam::device
