// The formats behind read_mesh, one function each: the bytes of a file to a polygon soup that has not been checked yet.
#pragma once

#include <array>
#include <string>
#include <vector>

namespace vam::io {

/// Points and faces as the file has them. Indices may be anything; check() in mesh_file.cpp judges them.
struct PolygonSoup {
  std::vector<std::array<double, 3>> points;
  std::vector<std::vector<int>> faces;
};

/// What a parser has to say about bytes it cannot read: the rest of the sentence that begins with the file's name.
struct MeshProblem {
  std::string text;
};

/// 84 bytes of header and count, then 50 bytes a triangle. Throws MeshProblem when the size is not that.
[[nodiscard]] PolygonSoup parse_binary_stl(const std::string& bytes);
/// True when the size is exactly what the triangle count in the header asks for.
[[nodiscard]] bool has_binary_stl_size(const std::string& bytes);

/// By CGAL; each throws MeshProblem when CGAL gives up.
[[nodiscard]] PolygonSoup parse_ascii_stl(const std::string& bytes);
[[nodiscard]] PolygonSoup parse_obj(const std::string& bytes);
[[nodiscard]] PolygonSoup parse_ply(const std::string& bytes);
[[nodiscard]] PolygonSoup parse_off(const std::string& bytes);

/// By assimp, with every build item placed and the model's unit converted to mm. Throws MeshProblem.
[[nodiscard]] PolygonSoup parse_3mf(const std::string& bytes);

}  // namespace vam::io
