// What device strings may begin with, before the colon. The tables of lib/device/open hold how each is opened, and the
// compiler compares them with these; help texts, the comments of the printer file and tests/tools/devices.t follow.
#pragma once

#include <algorithm>
#include <array>
#include <string>
#include <string_view>

namespace vam::model {

struct DeviceScheme {
  std::string_view scheme;
  std::string_view place;  // what follows the colon, for people
};

inline constexpr std::array stage_schemes{DeviceScheme{"gcs", "PATH"}, DeviceScheme{"tic", "SERIAL"},
                                          DeviceScheme{"grbl", "PATH"}, DeviceScheme{"zaber", "PATH"},
                                          DeviceScheme{"sim", ""}};
inline constexpr std::array camera_schemes{DeviceScheme{"aravis", "ID-or-IP"}, DeviceScheme{"v4l2", "PATH"},
                                           DeviceScheme{"replay", "PLACE"}, DeviceScheme{"sim", ""}};
inline constexpr std::array display_schemes{DeviceScheme{"drm", "CONNECTOR"}, DeviceScheme{"sdl", "SCREEN"},
                                            DeviceScheme{"null", ""}};
inline constexpr std::array light_schemes{DeviceScheme{"dlpc350", "SERIAL"}, DeviceScheme{"dlpc900", "SERIAL"},
                                          DeviceScheme{"sim", ""}};
inline constexpr std::array relay_schemes{DeviceScheme{"relay", "PATH"}, DeviceScheme{"sim", ""}};

/// "a:PATH, b:SERIAL or sim:", of a table whose rows have a scheme and a place.
[[nodiscard]] std::string forms_of(const auto& table) {
  std::string forms;
  for (auto row = std::begin(table); row != std::end(table); ++row) {
    if (row != std::begin(table)) forms += row + 1 != std::end(table) ? ", " : " or ";
    forms += std::string(row->scheme) + ":" + std::string(row->place);
  }
  return forms;
}

/// Whether a table of backends has these schemes, in their order.
template <class Backends, class Schemes>
constexpr bool has_schemes(const Backends& backends, const Schemes& schemes) {
  return std::equal(std::begin(backends), std::end(backends), schemes.begin(), schemes.end(),
                    [](const auto& backend, const DeviceScheme& known) { return backend.scheme == known.scheme; });
}

}  // namespace vam::model
