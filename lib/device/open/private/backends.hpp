// A table of backends, one row per scheme: {"gcs", "PATH", open_gcs}. A scheme that is not in the table cannot be
// opened, and the row is also its line in --help.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "device/os/address.hpp"

namespace vam::device {

template <class Backend, std::size_t count>
[[nodiscard]] std::vector<std::string> schemes_of(const Backend (&backends)[count]) {
  std::vector<std::string> schemes;
  for (const Backend& backend : backends) schemes.emplace_back(backend.scheme);
  return schemes;
}

/// Throws Fault::usage when there is no device of this kind: a simulator is used only if it is named.
inline void require_named(const std::string& device, const std::string& kind, const std::string& example) {
  if (!device.empty()) return;
  throw Error{Fault::usage, kind + ": none is named; give --device or " + kind +
                                ".device of the printer file, such as " + example + "; sim: is a simulated one"};
}

/// "gcs:PATH, tic:SERIAL or sim:"
template <class Backend, std::size_t count>
[[nodiscard]] std::string forms_of(const Backend (&backends)[count]) {
  std::string forms;
  for (std::size_t i = 0; i < count; ++i) {
    if (i > 0) forms += i + 1 < count ? ", " : " or ";
    forms += std::string(backends[i].scheme) + ":" + backends[i].place;
  }
  return forms;
}

/// The address was parsed with schemes_of(backends), so one of them has its scheme.
template <class Backend, std::size_t count>
[[nodiscard]] const Backend& backend_of(const Backend (&backends)[count], const Address& address) {
  const Backend* found = backends;
  while (address.scheme != found->scheme) ++found;
  return *found;
}

}  // namespace vam::device
