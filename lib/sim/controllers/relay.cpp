// SPDX-License-Identifier: GPL-3.0-or-later
// Source of all of it: the firmware that [devices §7] prints.
#include <utility>

#include "base/text/json.hpp"
#include "sim/controllers/controllers.hpp"
#include "sim/controllers/private/controller.hpp"

namespace vam::sim {

namespace {

constexpr double limit_s = 0.3;

class SimRelay final : public SimController {
 public:
  using SimController::SimController;

  // Another question than a heartbeat's comes too late when the time is over.
  void advance(double now_s) override {
    SimController::advance(now_s);
    if (closed_ && now_s_ > last_s_ + limit_s) open("heartbeat");
  }

 private:
  void open(const char* why) {
    if (std::exchange(closed_, false)) note("open", {{"reason", why}});
  }

  void on_byte(char command) override {
    const std::string name(1, command);
    const std::string fault = record_command(name, name);
    if (silent()) return;
    if (command == 'A') {
      if (!std::exchange(closed_, fault != "error")) note("closed", Json::object());
    } else if (command == 'O') {
      open("order");
    } else if (command != 'H' && command != '?') {
      return;
    }
    if (command == 'A' || command == 'H') last_s_ = now_s_;
    reply_with_fault(fault, command == '?' ? "vam-relay 1 300 simulated\r\n" : closed_ ? "closed\r\n" : "open\r\n", "");
  }

  double last_s_ = 0;
  bool closed_ = false;
};

}  // namespace

std::unique_ptr<SimDevice> make_sim_relay(const SimGcsSettings& settings, double now_s, SimLog log) {
  return std::make_unique<SimRelay>(settings, now_s, std::move(log));
}

}  // namespace vam::sim
