#include "device/open/light.hpp"

#include <algorithm>

#include "device/open/private/backends.hpp"
#include "device/os/clock.hpp"
#include "sim/controllers/dlp.hpp"

namespace vam::device {

namespace {

std::unique_ptr<LightEngine> open_sim(const Address& address, const LightSettings& settings, Guardian*) {
  address.allow({"current", "max_current", "leds", "log"});
  return make_dlp_light(sim::make_sim_dlp({}, sim::file_sim_log(address.word("log", ""))), settings, real_clock(),
                        nullptr);
}

std::unique_ptr<LightEngine> open_dlp(const Address& address, const LightSettings& settings, Guardian* guardian) {
  address.allow({"current", "max_current", "leds"});
  const int product = address.scheme == "dlpc900" ? dlpc900_product : dlpc350_product;
  auto link = open_usb({0x0451, {product}, address.place}, 0);
  auto lock = std::make_unique<DeviceLock>(link->name());
  if (guardian != nullptr) guardian->keep(lock->handle());
  auto light = make_dlp_light(std::move(link), settings, real_clock(), guardian);
  light->hold(std::move(lock));
  return light;
}

struct LightBackend {
  const char* scheme;
  const char* place;  // for people
  std::unique_ptr<LightEngine> (*open)(const Address& address, const LightSettings& settings, Guardian* guardian);
};

constexpr LightBackend backends[] = {
    {"dlpc350", "SERIAL", open_dlp}, {"dlpc900", "SERIAL", open_dlp}, {"sim", "", open_sim}};

}  // namespace

std::string light_devices() { return forms_of(backends); }

std::unique_ptr<LightEngine> open_light(const std::string& device, int max_current, Guardian* guardian) {
  const Address address = parse_address(device, schemes_of(backends));
  LightSettings settings;
  settings.current = address.integer("current", 0, 255);
  settings.max_current = std::min(max_current, address.integer("max_current", 0, 255).value_or(max_current));
  settings.leds = address.word("leds", settings.leds);
  return backend_of(backends, address).open(address, settings, guardian);
}

}  // namespace vam::device
