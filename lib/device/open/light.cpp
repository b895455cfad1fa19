// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>

#include "device/open/open.hpp"
#include "device/open/private/backends.hpp"
#include "device/os/clock.hpp"
#include "device/port/usb_kinds.hpp"
#include "model/device_schemes.hpp"
#include "sim/controllers/dlp.hpp"

namespace vam::device {

namespace {

std::unique_ptr<LightEngine> open_sim(const Address& address, const LightSettings& settings, Guardian*) {
  return make_dlp_light(sim::make_sim_dlp({}, sim::file_sim_log(address.word("log", ""))), settings, real_clock(),
                        nullptr);
}

std::unique_ptr<LightEngine> open_dlp(const Address& address, const LightSettings& settings, Guardian* guardian) {
  std::unique_ptr<DeviceLock> lock;  // first: of a claimed interface nobody says whose it is
  auto link = open_usb(usb_id(address.scheme, address.place), 0,
                       [&](const std::string& name) { lock = std::make_unique<DeviceLock>(name); });
  if (guardian != nullptr) guardian->keep(lock->handle());
  auto light = make_dlp_light(std::move(link), settings, real_clock(), guardian);
  light->hold(std::move(lock));
  return light;
}

struct LightBackend {
  const char* scheme;
  std::unique_ptr<LightEngine> (*open)(const Address& address, const LightSettings& settings, Guardian* guardian);
};

constexpr LightBackend backends[] = {{"dlpc350", open_dlp}, {"dlpc900", open_dlp}, {"sim", open_sim}};
static_assert(model::has_schemes(backends, model::light_schemes));

}  // namespace

std::unique_ptr<LightEngine> open_light(const std::string& device, double max_current_percent, Guardian* guardian) {
  const Address address = parse_device(device, model::light_schemes);
  LightSettings settings;
  if (address.options.contains("current_percent")) {
    settings.current_percent = address.number("current_percent", 0, 0, 100);
  }
  settings.max_current_percent =
      std::min(max_current_percent, address.number("max_current_percent", max_current_percent, 0, 100));
  settings.leds = address.word("leds", settings.leds);
  return backend_of(backends, address).open(address, settings, guardian);
}

}  // namespace vam::device
