// SPDX-License-Identifier: GPL-3.0-or-later
// Device strings: "gcs:/dev/ttyUSB0?baud=115200&address=2" is scheme, place and options.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace vam::device {

struct Address {
  std::string text;    // as given, for messages
  std::string scheme;  // what is before the first colon
  std::string place;   // path, serial number, connector; may be empty
  std::map<std::string, std::string> options;

  /// The option as a number within [low, high], or fallback. Throws Fault::usage.
  [[nodiscard]] double number(const std::string& key, double fallback, double low, double high) const;
  [[nodiscard]] std::optional<int> integer(const std::string& key, int low, int high) const;
  [[nodiscard]] std::string word(const std::string& key, const std::string& fallback) const;
  /// Throws Fault::usage naming the nearest known key when an option is not in `known`.
  void allow(const std::vector<std::string>& known) const;
};

/// Throws Fault::usage: no scheme, a scheme that is not in `schemes`, an option without "=" or given twice.
[[nodiscard]] Address parse_address(const std::string& text, const std::vector<std::string>& schemes);

}  // namespace vam::device
