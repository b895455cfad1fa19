// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <iterator>

#include "device/open/open.hpp"
#include "device/open/private/backends.hpp"
#include "device/projector/display_backends.hpp"
#include "model/device_schemes.hpp"

namespace vam::device {

namespace {

struct DisplayBackend {
  const char* scheme;
  std::unique_ptr<Display> (*open)(const Address& address, const DisplayMode& wanted, Clock& clock, Guardian* guardian);
};

constexpr DisplayBackend backends[] = {
    {"drm", open_drm_display}, {"sdl", open_sdl_display}, {"null", open_null_display}};
static_assert(model::has_schemes(backends, model::display_schemes));

}  // namespace

bool names_display(const std::string& output) {
  return std::any_of(std::begin(backends), std::end(backends), [&](const DisplayBackend& backend) {
    return output.rfind(std::string(backend.scheme) + ":", 0) == 0;
  });
}

std::unique_ptr<Display> open_display(const std::string& device, const DisplayMode& wanted, Clock& clock,
                                      Guardian* guardian) {
  const Address address = parse_device(device, model::display_schemes);
  return backend_of(backends, address).open(address, wanted, clock, guardian);
}

}  // namespace vam::device
