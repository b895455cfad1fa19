// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/error.hpp"
#include "device/open/open.hpp"
#include "device/open/private/backends.hpp"
#include "device/os/lock.hpp"
#include "device/port/serial_port.hpp"
#include "device/port/usb_kinds.hpp"
#include "device/stage/stage_backends.hpp"
#include "model/device_schemes.hpp"
#include "sim/controllers/controllers.hpp"

namespace vam::device {

namespace {

std::unique_ptr<Stage> open_sim(const Address& address, Clock& clock, Guardian* guardian) {
  auto device =
      sim::make_sim_gcs(sim::sim_settings(address), clock.now_s(), sim::file_sim_log(address.word("log", "")));
  return make_gcs_stage(sim::make_sim_port(std::move(device), clock), clock, {}, "1", guardian);
}

// The guardian holds the lock too: the device is not released before it is safe.
std::unique_ptr<DeviceLock> lock_device(const std::string& name, Guardian* guardian) {
  auto lock = std::make_unique<DeviceLock>(name);
  if (guardian != nullptr) guardian->keep(lock->handle());
  return lock;
}

std::unique_ptr<Stage> open_gcs(const Address& address, Clock& clock, Guardian* guardian) {
  GcsSettings settings;
  settings.address = address.integer("address", 1, 16);
  settings.timeout_s = address.number("timeout_s", settings.timeout_s, 0.01, 0.4);
  auto lock = lock_device(address.place, guardian);
  const std::string axis = address.word("axis", "1");
  GcsLink link(find_gcs(address.place, address.integer("baud", 50, 4000000), clock, settings), clock, settings);
  require_axis(link, axis);
  auto stage = make_gcs_stage(link.take_port(), clock, settings, axis, guardian);
  stage->hold(std::move(lock));
  (void)stage->fault();  // what an earlier user left behind, "stopped by command" for one
  return stage;
}

std::unique_ptr<Stage> open_grbl(const Address& address, Clock& clock, Guardian* guardian) {
  const std::string axis = address.word("axis", "X");
  if (axis != "X" && axis != "Y" && axis != "Z") {
    throw Error{Fault::usage, "device '" + address.text + "': axis=" + axis + " is not one of X, Y, Z"};
  }
  const std::string home = address.word("home", "switch");
  if (home != "switch" && home != "here") {
    throw Error{Fault::usage, "device '" + address.text + "': home=" + home + " is not one of switch, here"};
  }
  auto lock = lock_device(address.place, guardian);
  auto port = open_serial(address.place, address.integer("baud", 50, 4000000).value_or(115200));
  auto stage = make_grbl_stage(std::move(port), clock, axis.front() - 'X', guardian, home == "here");
  stage->hold(std::move(lock));
  return stage;
}

std::unique_ptr<Stage> open_tic(const Address& address, Clock& clock, Guardian* guardian) {
  const double steps_per_deg = address.number("steps_per_deg", 0, -1e6, 1e6);
  if (steps_per_deg == 0) {
    throw Error{Fault::usage,
                "device '" + address.text + "': needs ?steps_per_deg=N, the microsteps per degree of the stage"};
  }
  auto link = open_usb(usb_id("tic", address.place), -1);
  auto lock = lock_device(link->name(), guardian);
  auto stage = make_tic_stage(std::move(link), clock, steps_per_deg, guardian);
  stage->hold(std::move(lock));
  return stage;
}

std::unique_ptr<Stage> open_zaber(const Address& address, Clock& clock, Guardian* guardian) {
  ZaberSettings settings;
  settings.address = address.integer("address", 1, 99).value_or(settings.address);
  settings.axis = address.integer("axis", 1, 9).value_or(settings.axis);
  settings.steps_per_deg = address.number("steps_per_deg", settings.steps_per_deg, -1e6, 1e6);
  auto lock = lock_device(address.place, guardian);
  auto port = open_serial(address.place, address.integer("baud", 50, 4000000).value_or(115200));
  auto stage = make_zaber_stage(std::move(port), clock, settings, guardian);
  stage->hold(std::move(lock));
  (void)stage->fault();  // what an earlier user left behind
  return stage;
}

struct StageBackend {
  const char* scheme;
  std::unique_ptr<Stage> (*open)(const Address& address, Clock& clock, Guardian* guardian);
};

constexpr StageBackend backends[] = {
    {"gcs", open_gcs}, {"tic", open_tic}, {"grbl", open_grbl}, {"zaber", open_zaber}, {"sim", open_sim}};
static_assert(model::has_schemes(backends, model::stage_schemes));

}  // namespace

std::unique_ptr<Stage> open_stage(const std::string& device, Clock& clock, Guardian* guardian) {
  require_named(device, "stage", "gcs:/dev/ttyUSB0");
  const Address address = parse_device(device, model::stage_schemes);
  return backend_of(backends, address).open(address, clock, guardian);
}

}  // namespace vam::device
