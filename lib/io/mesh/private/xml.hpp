// SPDX-License-Identifier: GPL-3.0-or-later
// XML as it passes by, element by element, through Expat.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>

namespace vam::io {

/// An element that begins.
struct XmlElement {
  std::string_view space;  // its namespace
  std::string_view name;   // without a prefix
  const char** attributes;
  /// By its name without a prefix, of whatever namespace.
  [[nodiscard]] std::optional<std::string_view> attribute(std::string_view wanted) const;
};

struct XmlEvents {
  std::function<void(const XmlElement&)> begin;
  std::function<void()> end;                                                     // of the element that began last
  std::function<void(std::string_view prefix, std::string_view space)> declare;  // xmlns:prefix, before its element
};

using ByteFeed = std::function<void(const std::function<void(std::string_view)>&)>;

/// Throws MeshProblem: not well-formed, a document type declaration (entities), a tag or comment of more than 1 MiB;
/// and what the events throw.
void parse_xml(const ByteFeed& feed, const XmlEvents& events);

}  // namespace vam::io
