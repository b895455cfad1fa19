// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <utility>

#include "base/error.hpp"
#include "sim/controllers/device.hpp"

namespace vam::sim {

namespace {

class SimPort final : public device::Port {
 public:
  SimPort(std::unique_ptr<SimDevice> device, device::Clock& clock) : device_(std::move(device)), clock_(clock) {
    device_->opened(clock_.now_s());
  }

  void write(std::string_view bytes) override {
    require_plugged();
    device_->receive(bytes, clock_.now_s());
  }

  std::string read(double timeout_s) override {
    const double deadline_s = clock_.now_s() + timeout_s;
    device_->advance(clock_.now_s());
    require_plugged();
    const double due_s = device_->next_due_s().value_or(deadline_s);
    clock_.sleep_until(std::min(due_s, deadline_s));
    device_->advance(clock_.now_s());
    require_plugged();
    return device_->take(clock_.now_s());
  }

  const std::string& name() const override { return name_; }

 private:
  void require_plugged() const {
    if (device_->unplugged()) throw Error{Fault::absent, name_ + ": unplugged"};
  }
  std::unique_ptr<SimDevice> device_;
  device::Clock& clock_;
  std::string name_ = "sim:";
};

}  // namespace

std::unique_ptr<device::Port> make_sim_port(std::unique_ptr<SimDevice> device, device::Clock& clock) {
  return std::make_unique<SimPort>(std::move(device), clock);
}

}  // namespace vam::sim
