#include "device/open/display.hpp"

#include <algorithm>
#include <iterator>

#include "device/open/private/backends.hpp"
#include "device/projector/display_backends.hpp"

namespace vam::device {

namespace {

struct DisplayBackend {
  const char* scheme;
  const char* place;  // for people
  std::unique_ptr<Display> (*open)(const Address& address, const DisplayMode& wanted, Clock& clock, Guardian* guardian);
};

constexpr DisplayBackend backends[] = {
    {"drm", "CONNECTOR", open_drm_display}, {"sdl", "SCREEN", open_sdl_display}, {"null", "", open_null_display}};

}  // namespace

bool names_display(const std::string& output) {
  return std::any_of(std::begin(backends), std::end(backends), [&](const DisplayBackend& backend) {
    return output.rfind(std::string(backend.scheme) + ":", 0) == 0;
  });
}

std::unique_ptr<Display> open_display(const std::string& device, const DisplayMode& wanted, Clock& clock,
                                      Guardian* guardian) {
  const Address address = parse_address(device, schemes_of(backends));
  return backend_of(backends, address).open(address, wanted, clock, guardian);
}

}  // namespace vam::device
