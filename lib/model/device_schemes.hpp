// What the device strings of a printer file may begin with, before the colon. The tables of lib/device/open hold how
// each is opened.
#pragma once

#include <algorithm>
#include <array>
#include <string_view>

namespace vam::model {

inline constexpr std::array<std::string_view, 4> stage_schemes{"gcs", "tic", "grbl", "sim"};
inline constexpr std::array<std::string_view, 4> camera_schemes{"aravis", "v4l2", "replay", "sim"};

/// Whether a table of backends has these schemes, in their order.
template <class Backends, class Schemes>
constexpr bool has_schemes(const Backends& backends, const Schemes& schemes) {
  return std::equal(std::begin(backends), std::end(backends), schemes.begin(), schemes.end(),
                    [](const auto& backend, std::string_view scheme) { return backend.scheme == scheme; });
}

}  // namespace vam::model
