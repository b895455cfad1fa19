// A table of backends, one row per scheme: {"gcs", open_gcs}. A scheme that is not in the table cannot be opened.
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
  throw Error{Fault::usage, kind + ": no device is set; give --device, or " + kind +
                                ".device in the printer file, e.g. " + example + "; sim: is a simulated one"};
}

/// The address was parsed with schemes_of(backends), so one of them has its scheme.
template <class Backend, std::size_t count>
[[nodiscard]] const Backend& backend_of(const Backend (&backends)[count], const Address& address) {
  const Backend* found = backends;
  while (address.scheme != found->scheme) ++found;
  return *found;
}

}  // namespace vam::device
