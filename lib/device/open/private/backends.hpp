// A table of backends, one a scheme: {"gcs", open_gcs}. What is not in the table cannot be opened.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "device/os/address.hpp"

namespace vam::device {

template <class Backend, std::size_t count>
[[nodiscard]] std::vector<std::string> schemes_of(const Backend (&backends)[count]) {
  std::vector<std::string> schemes;
  for (const Backend& backend : backends) schemes.emplace_back(backend.scheme);
  return schemes;
}

/// The address was parsed with schemes_of(backends), so one of them has its scheme.
template <class Backend, std::size_t count>
[[nodiscard]] const Backend& backend_of(const Backend (&backends)[count], const Address& address) {
  const Backend* found = backends;
  while (address.scheme != found->scheme) ++found;
  return *found;
}

}  // namespace vam::device
