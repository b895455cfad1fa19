#include "io/mesh/file.hpp"

#include <cmath>
#include <limits>
#include <utility>

#include "base/error.hpp"
#include "base/text.hpp"
#include "io/mesh/private/formats.hpp"
#include "io/stream/stream.hpp"

namespace vam::io {

namespace {

// By content, whatever the name.
PolygonSoup parse(const std::string& bytes) {
  if (bytes.empty()) throw MeshProblem{"is empty"};
  for (const MeshFormat& format : mesh_formats()) {
    if (format.recognises(bytes)) return format.read(bytes);
  }
  // No other binary format is left: its reader reports what is missing.
  if (bytes.find('\0') != std::string::npos) return parse_stl(bytes);
  throw MeshProblem{"not a mesh of a known format (" + mesh_format_names() + ")"};
}

// The format of a name that is written; standard output is the first one.
const MeshFormat& format_of_output(const std::string& path) {
  std::vector<std::string> endings;
  for (const MeshFormat& format : mesh_formats()) {
    if (format.write == nullptr) continue;
    if (path == "-" || path.ends_with(format.extension)) return format;
    endings.push_back(format.extension);
  }
  throw Error{Fault::usage, path + ": no mesh format that is written has this ending; use " + join(endings, " or ")};
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

std::string mesh_format_names() {
  std::vector<std::string> names;
  for (const MeshFormat& format : mesh_formats()) names.push_back(format.name);
  return join(names, ", ");
}

void check_mesh_output(const std::string& path) { (void)format_of_output(path); }

void write_mesh(const std::string& path, const model::TriangleSoup& mesh, const std::vector<std::string>& comments) {
  format_of_output(path).write(path, mesh, comments);
}

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
