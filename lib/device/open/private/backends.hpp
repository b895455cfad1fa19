// SPDX-License-Identifier: GPL-3.0-or-later
// A table of backends, one row per scheme: {"gcs", open_gcs}. A scheme that is not in the table cannot be opened.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "device/os/address.hpp"
#include "model/device_schemes.hpp"

namespace vam::device {

/// Scheme, place and options as they stand. Throws Fault::usage for a scheme that is not in the table.
[[nodiscard]] inline Address parse_scheme(const std::string& device, std::span<const model::DeviceScheme> table) {
  std::vector<std::string> schemes;
  for (const auto& row : table) schemes.emplace_back(row.scheme);
  return parse_address(device, schemes);
}

/// Throws Fault::usage for an option that the table does not have.
[[nodiscard]] inline Address with_known_options(Address address, std::span<const model::DeviceScheme> table) {
  auto row = table.begin();
  while (address.scheme != row->scheme) ++row;
  std::vector<std::string> known;
  for (const auto& option : row->options) known.emplace_back(option.name);
  address.allow(known);
  return address;
}

[[nodiscard]] inline Address parse_device(const std::string& device, std::span<const model::DeviceScheme> table) {
  return with_known_options(parse_scheme(device, table), table);
}

/// Throws Fault::usage when there is no device of this kind: a simulator is used only if it is named.
inline void require_named(const std::string& device, const std::string& kind, const std::string& example) {
  if (!device.empty()) return;
  throw Error{Fault::usage, kind + ": no device is set; give --device, or " + kind +
                                ".device in the printer file, e.g. " + example + "; sim: is a simulated one"};
}

/// The address was parsed with the table that has the schemes of `backends`, so one of them has its scheme.
template <class Backend, std::size_t count>
[[nodiscard]] const Backend& backend_of(const Backend (&backends)[count], const Address& address) {
  const Backend* found = backends;
  while (address.scheme != found->scheme) ++found;
  return *found;
}

}  // namespace vam::device
