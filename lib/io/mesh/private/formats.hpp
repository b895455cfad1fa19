// SPDX-License-Identifier: GPL-3.0-or-later
// The table of mesh formats behind read_mesh and write_mesh. A reader turns the bytes of a file into a polygon soup
// that has not been checked yet. A new format is one row and its reader.
#pragma once

#include <array>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

#include "model/mesh.hpp"

namespace vam::io {

/// Points and faces as the file has them. Indices may be anything; check_points() and triangulated() in file.cpp judge
/// them.
struct PolygonSoup {
  std::vector<std::array<double, 3>> points;
  std::vector<std::vector<int>> faces;
  std::vector<std::array<std::uint8_t, 3>> colours = {};  // one a point, or none
  std::vector<float> uncertainty = {};                    // the same
  std::size_t taken_away = 0;                             // last faces, triangles around what is no part
  bool of_facets = false;                                 // three points a face, in its order
};

/// What a parser has to say about bytes it cannot read: the rest of the sentence that begins with the file's name.
struct MeshProblem : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Throws MeshProblem where a header states more than its file can hold: every vertex and face takes at least two
/// bytes, so a larger count must not become an allocation.
void require_count(std::uint64_t count, const char* what, const std::string& bytes);
/// Throws MeshProblem where more faces follow than a header states.
void require_all_read(std::uint64_t promised, std::uint64_t found);
/// Throws MeshProblem: the file ends, or is damaged, behind what was read.
[[noreturn]] void give_up(const char* format, const PolygonSoup& soup);

struct MeshFormat {
  std::string extension;                          // of files that are written: ".stl"
  std::string name;                               // for people: "STL"
  bool (*recognises)(const std::string& bytes);   // not empty
  PolygonSoup (*read)(const std::string& bytes);  // throws MeshProblem
  void (*write)(const std::string& path, const model::TriangleSoup& mesh,
                const std::vector<std::string>& comments);  // null: only read
};

/// In the order in which contents are tried.
[[nodiscard]] const std::vector<MeshFormat>& mesh_formats();

/// What the triangle count in the header asks for; 0 where there is no header.
[[nodiscard]] std::uint64_t binary_stl_bytes(const std::string& bytes);
/// True when that is exactly the size.
[[nodiscard]] bool has_binary_stl_size(const std::string& bytes);

/// The format whose text these bytes are but for some that are 0: "OBJ", "ASCII STL"; empty: they are none.
[[nodiscard]] std::string text_format_of(const std::string& bytes);

/// Capitals of ASCII as small letters.
[[nodiscard]] std::string lower_case(std::string text);

/// Farther from the origin no mesh has points, whatever its unit: a kilometre in nm.
inline constexpr double farthest_point = 1e12;

/// Each throws MeshProblem; STL is binary or text.
[[nodiscard]] PolygonSoup parse_stl(const std::string& bytes);
[[nodiscard]] PolygonSoup parse_obj(const std::string& bytes);
[[nodiscard]] PolygonSoup parse_ply(const std::string& bytes);
[[nodiscard]] PolygonSoup parse_off(const std::string& bytes);

/// Every build item placed with its components, the model's unit converted to mm. Throws MeshProblem: what the parts
/// throw, a component loop, more than 2^25 triangles, 2^26 vertices or 2^20 objects in all, or more than fit in the
/// memory of the child for a file of its size, an object that is not printed or not what its mesh says.
[[nodiscard]] PolygonSoup parse_3mf(const std::string& bytes);
/// A zip archive.
[[nodiscard]] bool is_3mf(const std::string& bytes);
/// In mm; the same bytes for the same mesh. Triangles that use a point twice are left out, as the format has none.
void write_3mf(const std::string& path, const model::TriangleSoup& mesh, const std::vector<std::string>& comments);

}  // namespace vam::io
