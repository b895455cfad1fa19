// SPDX-License-Identifier: GPL-3.0-or-later
#include "device/open/open.hpp"
#include "device/open/private/backends.hpp"
#include "device/os/clock.hpp"
#include "device/os/lock.hpp"
#include "device/port/serial_port.hpp"
#include "model/device_schemes.hpp"
#include "sim/controllers/controllers.hpp"

namespace vam::device {

namespace {

std::unique_ptr<Relay> open_sim(const Address& address, Guardian* guardian) {
  auto& clock = real_clock();
  auto device =
      sim::make_sim_relay(sim::sim_settings(address), clock.now_s(), sim::file_sim_log(address.word("log", "")));
  return std::make_unique<Relay>(sim::make_sim_port(std::move(device), clock), clock, guardian);
}

std::unique_ptr<Relay> open_serial_relay(const Address& address, Guardian* guardian) {
  auto lock = std::make_unique<DeviceLock>(address.place);
  if (guardian != nullptr) guardian->keep(lock->handle());
  auto relay = std::make_unique<Relay>(
      open_serial(address.place, address.integer("baud", 50, 4000000).value_or(115200)), real_clock(), guardian);
  relay->hold(std::move(lock));
  return relay;
}

struct RelayBackend {
  const char* scheme;
  std::unique_ptr<Relay> (*open)(const Address& address, Guardian* guardian);
};

constexpr RelayBackend backends[] = {{"relay", open_serial_relay}, {"sim", open_sim}};
static_assert(model::has_schemes(backends, model::relay_schemes));

}  // namespace

std::unique_ptr<Relay> open_relay(const std::string& device, Guardian* guardian) {
  if (device.empty()) return nullptr;
  const Address address = parse_device(device, model::relay_schemes);
  return backend_of(backends, address).open(address, guardian);
}

}  // namespace vam::device
