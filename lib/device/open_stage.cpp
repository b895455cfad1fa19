#include "base/error.hpp"
#include "device/gcs_stage.hpp"
#include "device/lock.hpp"
#include "device/sim_options.hpp"
#include "device/stage.hpp"

namespace vam::device {

namespace {

std::unique_ptr<Stage> open_sim(const Address& address, Clock& clock, Guardian* guardian) {
  address.allow(sim_option_names());
  auto device = make_sim_gcs(sim_settings(address), clock.now_s(), file_sim_log(address.word("log", "")));
  return make_gcs_stage(make_sim_port(std::move(device), clock), clock, {}, "1", guardian);
}

// The guardian holds the lock too: nobody gets the device before it is safe.
std::unique_ptr<DeviceLock> lock_device(const std::string& name, Guardian* guardian) {
  auto lock = std::make_unique<DeviceLock>(name);
  if (guardian != nullptr) guardian->keep(lock->handle());
  return lock;
}

std::unique_ptr<Stage> open_gcs(const Address& address, Clock& clock, Guardian* guardian) {
  address.allow({"baud", "address", "axis", "timeout_s"});
  GcsSettings settings;
  settings.address = address.integer("address", 1, 16);
  settings.timeout_s = address.number("timeout_s", settings.timeout_s, 0.01, 0.4);
  auto lock = lock_device(address.place, guardian);
  auto port = find_gcs(address.place, address.integer("baud", 50, 4000000), clock, settings);
  auto stage = make_gcs_stage(std::move(port), clock, settings, address.word("axis", "1"), guardian);
  stage->hold(std::move(lock));
  (void)stage->fault();  // what a former user left behind, "stopped by command" for one
  return stage;
}

}  // namespace

const std::vector<std::string>& stage_schemes() {
  static const std::vector<std::string> schemes{"sim", "gcs"};
  return schemes;
}

std::unique_ptr<Stage> open_stage(const std::string& device, Clock& clock, Guardian* guardian) {
  const Address address = parse_address(device, stage_schemes());
  if (address.scheme == "sim") return open_sim(address, clock, guardian);
  return open_gcs(address, clock, guardian);
}

}  // namespace vam::device
