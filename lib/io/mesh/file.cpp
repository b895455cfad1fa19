#include "io/mesh/file.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string_view>
#include <utility>

#include "base/error.hpp"
#include "io/mesh/private/formats.hpp"
#include "io/stream/stream.hpp"

namespace vam::io {

namespace {

bool starts_with_word(std::string_view text, std::string_view word) {
  return text.starts_with(word) && text.size() > word.size() &&
         std::string_view(" \t\r\n").find(text[word.size()]) != text.npos;
}

// A line of an OBJ file that nothing else has: "v x y z" or "f a b c" at its start.
bool looks_like_obj(const std::string& bytes) {
  const std::string_view head = std::string_view(bytes).substr(0, 1 << 16);
  for (std::size_t line = 0; line < head.size();) {
    if (starts_with_word(head.substr(line), "v") || starts_with_word(head.substr(line), "f")) return true;
    const std::size_t end = head.find('\n', line);
    if (end == std::string_view::npos) return false;
    line = end + 1;
  }
  return false;
}

bool is_off(std::string_view text) {
  for (const char* magic : {"OFF", "COFF", "NOFF", "CNOFF", "STOFF"}) {
    if (starts_with_word(text, magic)) return true;
  }
  return false;
}

// By content. The size test comes before "solid": many programs begin the header of a binary STL with that word.
PolygonSoup parse(const std::string& bytes) {
  const std::string_view text =
      std::string_view(bytes).substr(std::min(bytes.find_first_not_of(" \t\r\n"), bytes.size()));
  if (bytes.empty()) throw MeshProblem{"is empty"};
  if (bytes.starts_with("PK\3\4")) return parse_3mf(bytes);
  if (starts_with_word(bytes, "ply")) return parse_ply(bytes);
  if (has_binary_stl_size(bytes)) return parse_binary_stl(bytes);
  if (is_off(text)) return parse_off(bytes);
  const bool binary = bytes.find('\0') != std::string::npos;
  if (!binary && starts_with_word(text, "solid")) return parse_ascii_stl(bytes);
  if (!binary && looks_like_obj(bytes)) return parse_obj(bytes);
  if (binary) return parse_binary_stl(bytes);  // no other binary format is left: it says what is missing
  throw MeshProblem{"not a mesh of a known format (STL, OBJ, PLY, OFF, 3MF)"};
}

void check_points(const PolygonSoup& soup) {
  constexpr auto limit = static_cast<std::size_t>(std::numeric_limits<int>::max());
  if (soup.points.size() > limit)
    throw MeshProblem{"has " + std::to_string(soup.points.size()) + " vertices, more than 2^31 - 1"};
  for (std::size_t i = 0; i < soup.points.size(); ++i) {
    for (const double x : soup.points[i]) {
      if (!std::isfinite(x))
        throw MeshProblem{"vertex " + std::to_string(i) + " is not finite (of " + std::to_string(soup.points.size()) +
                          ")"};
    }
  }
}

// A fan per polygon. For a concave one the fan folds over itself, yet every fold cancels in a signed volume.
model::TriangleSoup triangulated(PolygonSoup&& soup) {
  model::TriangleSoup mesh;
  const int points = static_cast<int>(soup.points.size());
  mesh.triangles.reserve(soup.faces.size());
  for (std::size_t f = 0; f < soup.faces.size(); ++f) {
    const auto& face = soup.faces[f];
    if (face.size() < 3)
      throw MeshProblem{"face " + std::to_string(f) + " has " + std::to_string(face.size()) + " corners"};
    for (const int corner : face) {
      if (corner < 0 || corner >= points) {
        throw MeshProblem{"face " + std::to_string(f) + " uses vertex " + std::to_string(corner) + " of " +
                          std::to_string(points) + " (counted from 0)"};
      }
    }
    for (std::size_t c = 2; c < face.size(); ++c) mesh.triangles.push_back({face[0], face[c - 1], face[c]});
  }
  if (mesh.triangles.empty()) throw MeshProblem{"the mesh is empty: " + std::to_string(points) + " vertices, no face"};
  mesh.points = std::move(soup.points);
  return mesh;
}

}  // namespace

model::TriangleSoup read_mesh(const std::string& path) {
  const std::string bytes = read_all(path, Content::binary);
  try {
    PolygonSoup soup = parse(bytes);
    check_points(soup);
    return triangulated(std::move(soup));
  } catch (const MeshProblem& problem) {
    throw Error{Fault::data, (path == "-" ? "stdin" : path) + ": " + problem.text};
  }
}

}  // namespace vam::io
