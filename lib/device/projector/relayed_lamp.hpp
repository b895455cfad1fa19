// SPDX-License-Identifier: GPL-3.0-or-later
// A lamp whose supply leads through a dead-man relay.
#pragma once

#include "device/projector/lamp.hpp"
#include "device/safety/relay.hpp"

namespace vam::device {

/// `engine` may be null. When a print fails the relay is told first, as a light engine may be slow to reply; at its end
/// the engine, which may get its power through the relay, is dark before the caller opens that.
class RelayedLamp final : public Lamp {
 public:
  RelayedLamp(Lamp* engine, Relay& relay) : engine_(engine), relay_(relay) {}
  void on() override {
    if (engine_ != nullptr) engine_->on();
  }
  void dark() override {
    if (engine_ != nullptr) engine_->dark();
  }
  void cut() override {
    relay_.cut();
    if (engine_ != nullptr) engine_->cut();
  }

 private:
  Lamp* engine_;
  Relay& relay_;
};

}  // namespace vam::device
