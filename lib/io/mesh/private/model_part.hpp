// SPDX-License-Identifier: GPL-3.0-or-later
// One model part of a 3MF package: the objects and the build of one XML document; and what its volumes are for.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/vector3.hpp"
#include "io/mesh/private/text.hpp"

namespace vam::io {

/// An element that begins.
struct XmlElement {
  std::string_view space;  // its namespace
  std::string_view name;   // without a prefix
  const char** attributes;
  /// By its name without a prefix, of whatever namespace.
  [[nodiscard]] std::optional<std::string_view> attribute(std::string_view wanted) const;
  /// Throws MeshProblem where it is missing, or no number.
  template <class Number = double>
  [[nodiscard]] Number number(std::string_view wanted) const {
    const auto value = number_of<Number>(attribute(wanted).value_or(""));
    if (!value) wrong(wanted);
    return *value;
  }
  /// Throws MeshProblem: what is wrong with the attribute.
  [[noreturn]] void wrong(std::string_view attribute) const;
};

struct XmlEvents {
  std::function<void(const XmlElement&)> begin;
  std::function<void()> end;                                                     // of the element that began last
  std::function<void(std::string_view prefix, std::string_view space)> declare;  // xmlns:prefix, before its element
  std::function<void(std::string_view)> text = {};                               // between elements, in pieces
};

using ByteFeed = std::function<void(const std::function<void(std::string_view)>&)>;

/// Throws MeshProblem: not well-formed, a document type declaration (entities), a tag or comment of more than 1 MiB;
/// and what the events throw.
void parse_xml(const ByteFeed& feed, const XmlEvents& events);

inline constexpr std::uint64_t max_triangles = std::uint64_t{1} << 25;  // of a package, and of what it expands to

/// Rows of the matrix of the 3MF core specification, 3.3: row vectors, (x y z 1) M; translations in mm.
struct ComponentPlacement {
  std::array<Vector3, 4> rows{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, 0}}};

  [[nodiscard]] Vector3 operator()(const Vector3& p) const;
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

/// What a volume is for.
enum class Role { added, taken_away, ignored, refused };

/// By the word with which the core specification or a slicer calls it; refused: one that is not printed, or not known.
[[nodiscard]] Role role_of(std::string_view type);

/// A volume that a slicer has made of some triangles of an object, or of one of its components.
struct VolumeType {
  unsigned object = 0;
  unsigned component = 0;  // its object; 0: triangles
  std::size_t first = 0;   // triangle
  std::size_t last = 0;
  std::string type;
};

/// Of the settings of PrusaSlicer or BambuStudio. Throws MeshProblem.
[[nodiscard]] std::vector<VolumeType> parse_volume_types(const ByteFeed& feed);

struct Object3mf {
  std::vector<std::array<double, 3>> points;  // mm
  std::vector<std::array<int, 3>> triangles;  // indices as the file has them
  std::vector<Instance> components;
  std::string type = "model";
  std::string problem;  // why it is not what its triangles say, behind its name; empty: it is
};

struct BeamEnd {
  int point = 0;  // of the object
  double radius_mm = 0;
  char cap = 's';  // or h, b: sphere, hemisphere, butt
};
/// Its length is more than 0.
using Beam = std::array<BeamEnd, 2>;
/// Appends closed surfaces, which may cross (3MF beam lattice extension 1.2): polygons of 8 to 48 sides, fewer the more
/// beams there are, have the areas of the cross-sections, polyhedra at the ends the volumes of the balls.
void append_beams(const std::vector<Beam>& beams, Object3mf& object);

struct ModelPart {
  std::map<unsigned, Object3mf> objects;
  std::vector<Instance> build;
};

/// Throws MeshProblem: not XML, no model, a unit or an extension that is not known, a number or a
/// reference that is none, more than 2^25 triangles or max_instances of objects, a document type declaration.
[[nodiscard]] ModelPart parse_model_part(const ByteFeed& feed);

/// The target of the first relationship whose type ends in "/3dmodel"; empty when there is none. Throws MeshProblem.
[[nodiscard]] std::string model_target(const ByteFeed& feed);

}  // namespace vam::io
