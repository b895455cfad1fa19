// SPDX-License-Identifier: GPL-3.0-or-later
#include "device/os/address.hpp"

#include <algorithm>
#include <cmath>

#include "base/error.hpp"
#include "base/text/text.hpp"

namespace vam::device {

namespace {

std::string list_of_schemes(const std::vector<std::string>& schemes) {
  std::vector<std::string> shown;
  for (const auto& scheme : schemes) shown.push_back(scheme + ":");
  return join(shown, ", ");
}

}  // namespace

Address parse_address(const std::string& text, const std::vector<std::string>& schemes) {
  const std::size_t colon = text.find(':');
  if (colon == std::string::npos) {
    throw Error{Fault::usage, "device '" + text + "': no scheme; begin with one of " + list_of_schemes(schemes)};
  }
  Address address{text, text.substr(0, colon), text.substr(colon + 1), {}};
  if (std::find(schemes.begin(), schemes.end(), address.scheme) == schemes.end()) {
    throw Error{Fault::usage, "device '" + text + "': unknown scheme; use one of " + list_of_schemes(schemes)};
  }
  const std::size_t question = address.place.find('?');
  if (question == std::string::npos) return address;
  const std::string tail = address.place.substr(question + 1);
  address.place.resize(question);
  for (const auto& part : split(tail, '&')) {
    const std::size_t equals = part.find('=');
    if (equals == std::string::npos || equals == 0) {
      throw Error{Fault::usage, "device '" + text + "': option '" + part + "' is not key=value"};
    }
    if (!address.options.emplace(part.substr(0, equals), part.substr(equals + 1)).second) {
      throw Error{Fault::usage, "device '" + text + "': option " + part.substr(0, equals) + " is given twice"};
    }
  }
  return address;
}

double Address::number(const std::string& key, double fallback, double low, double high) const {
  const auto found = options.find(key);
  if (found == options.end()) return fallback;
  const auto value = parse_number(found->second);
  if (!value || !(*value >= low && *value <= high)) {
    throw Error{Fault::usage, "device '" + text + "': " + key + "=" + found->second + " is not a number from " +
                                  format_number(low) + " to " + format_number(high)};
  }
  return *value;
}

std::optional<int> Address::integer(const std::string& key, int low, int high) const {
  if (!options.contains(key)) return std::nullopt;
  const double value = number(key, 0, low, high);
  if (value != std::floor(value)) {
    throw Error{Fault::usage, "device '" + text + "': " + key + "=" + options.at(key) + " is not a whole number"};
  }
  return static_cast<int>(value);
}

std::string Address::word(const std::string& key, const std::string& fallback) const {
  const auto found = options.find(key);
  return found == options.end() ? fallback : found->second;
}

void Address::allow(const std::vector<std::string>& known) const {
  for (const auto& [key, value] : options) {
    if (std::find(known.begin(), known.end(), key) == known.end()) {
      throw Error{Fault::usage, "device '" + text + "': unknown option " + key + did_you_mean(key, known) + " (" +
                                    scheme + " options: " + (known.empty() ? "none" : join(known, ", ")) + ")"};
    }
  }
}

}  // namespace vam::device
