#include "device/projector/display.hpp"

#include <algorithm>

#include "base/error.hpp"
#include "device/projector/private/display_backends.hpp"

namespace vam::device {

const std::vector<std::string>& display_schemes() {
  static const std::vector<std::string> schemes{"sdl", "drm", "null"};
  return schemes;
}

bool names_display(const std::string& output) {
  const auto& schemes = display_schemes();
  return std::any_of(schemes.begin(), schemes.end(),
                     [&](const std::string& scheme) { return output.rfind(scheme + ":", 0) == 0; });
}

std::vector<std::uint8_t> screen_bytes(const GreyImage& levels, const DisplayMode& mode) {
  if (levels.width != mode.columns || levels.height != mode.rows) {
    throw Error{Fault::data, "frames of " + std::to_string(levels.width) + " x " + std::to_string(levels.height) +
                                 " pixels do not fit the screen of " + std::to_string(mode.columns) + " x " +
                                 std::to_string(mode.rows) + "; set projector.columns and rows, or the screen's mode"};
  }
  if (levels.bits > 8) {
    throw Error{Fault::usage, "a screen shows 8 bits, not " + std::to_string(levels.bits) + "; give --bits 8"};
  }
  std::vector<std::uint8_t> bytes(levels.values.size());
  std::transform(levels.values.begin(), levels.values.end(), bytes.begin(),
                 [&](std::uint16_t level) { return static_cast<std::uint8_t>(level * 255 / levels.full()); });
  return bytes;
}

std::unique_ptr<Display> open_display(const std::string& device, const DisplayMode& wanted, Clock& clock,
                                      Guardian* guardian) {
  const Address address = parse_address(device, display_schemes());
  if (address.scheme == "null") return open_null_display(address, wanted, clock);
  if (address.scheme == "drm") return open_drm_display(address, clock, guardian);
  return open_sdl_display(address, clock, guardian);
}

}  // namespace vam::device
