// SPDX-License-Identifier: GPL-3.0-or-later
// One model part of a 3MF package: the objects and the build of one XML document.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

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

inline constexpr std::uint64_t max_triangles = std::uint64_t{1} << 25;  // of a package, and of what it expands to

/// Rows of the matrix of the 3MF core specification, 3.3: row vectors, (x y z 1) M; translations in mm.
struct ComponentPlacement {
  std::array<std::array<double, 3>, 4> rows{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, 0}}};

  [[nodiscard]] std::array<double, 3> operator()(const std::array<double, 3>& p) const;
  /// First this one, then `outer`.
  [[nodiscard]] ComponentPlacement then(const ComponentPlacement& outer) const;
  /// Turns the inside out.
  [[nodiscard]] bool mirrors() const;
};

/// An object somewhere: of a component, or of an item of the build.
struct Instance {
  std::string part;  // of another part of the package (production extension); empty: the same one
  unsigned object = 0;
  ComponentPlacement placement;
};

inline constexpr std::uint64_t max_instances = std::uint64_t{1} << 20;

struct Object3mf {
  std::vector<std::array<double, 3>> points;  // mm
  std::vector<std::array<int, 3>> triangles;  // indices as the file has them
  std::vector<Instance> components;
  bool support = false;  // holds a part up while it is printed; no part of it
  std::string unread;    // the element that makes up its shape and that is not read; empty: none
};

struct ModelPart {
  std::map<unsigned, Object3mf> objects;
  std::vector<Instance> build;
};

/// Throws MeshProblem: not XML, a unit or an extension that is not
/// known, a number or a reference that is none, more than 2^25 triangles or max_instances of objects, a document type
/// declaration.
[[nodiscard]] ModelPart parse_model_part(const ByteFeed& feed);

/// The target of the first relationship whose type ends in "/3dmodel"; empty when there is none. Throws MeshProblem.
[[nodiscard]] std::string model_target(const ByteFeed& feed);

}  // namespace vam::io
