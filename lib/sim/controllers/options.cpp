// SPDX-License-Identifier: GPL-3.0-or-later
#include <memory>

#include "base/text/json.hpp"
#include "base/text/text.hpp"
#include "device/os/event_log.hpp"
#include "sim/controllers/controllers.hpp"

namespace vam::sim {

SimGcsSettings sim_settings(const device::Address& address) {
  SimGcsSettings settings;
  settings.motor.speed_error = address.number("speed_error", settings.motor.speed_error, -0.5, 0.5);
  settings.motor.ripple = address.number("ripple", settings.motor.ripple, 0, 0.5);
  settings.motor.acceleration_deg_s2 = address.number("acceleration", settings.motor.acceleration_deg_s2, 1, 10000);
  settings.jitter_s = 1e-3 * address.number("jitter", 0, 0, 1000);
  settings.latency_s = 1e-3 * address.number("reply_delay", 1e3 * settings.latency_s, 0, 1000);
  settings.max_speed_deg_s = address.number("max_speed", settings.max_speed_deg_s, 1, 10000);
  settings.min_deg = address.number("min_angle", settings.min_deg, -1e7, 0);
  settings.max_deg = address.number("max_angle", settings.max_deg, 0, 1e7);
  settings.home_deg = address.number("start_angle", settings.home_deg, -180, 180);
  settings.referenced = true;  // it lives as long as one command: nobody could have homed it before
  settings.seed = static_cast<std::uint64_t>(address.integer("seed", 0, 1000000000).value_or(1));
  settings.address = address.integer("address", 1, 16).value_or(1);
  for (const auto& fault : split(address.word("fault", ""), ',')) settings.faults.push_back(parse_sim_fault(fault));
  return settings;
}

SimLog file_sim_log(const std::string& path) {
  if (path.empty()) return {};
  const auto log = std::make_shared<device::EventLog>(path);
  log->share();
  return [log](const Json& line) { log->line(line); };
}

}  // namespace vam::sim
