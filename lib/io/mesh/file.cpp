// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/mesh/file.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <tuple>
#include <utility>

#include "base/compute/memory.hpp"
#include "base/error.hpp"
#include "base/index.hpp"
#include "base/text/text.hpp"
#include "io/mesh/private/formats.hpp"
#include "io/stream/file_type.hpp"
#include "io/stream/sandboxed_reader.hpp"
#include "io/stream/stream.hpp"

namespace vam::io {

namespace {

constexpr std::uint64_t most_bytes = std::uint64_t{4} << 30;
constexpr std::size_t most_corners = std::size_t{1} << 16;  // of a face
constexpr std::size_t first_look = std::size_t{1} << 20;

// A mark that some editors put before text.
std::string without_mark(std::string bytes) {
  if (bytes.starts_with("\xef\xbb\xbf")) bytes.erase(0, 3);
  return bytes;
}

// By content, whatever the name. others: what else the caller reads.
PolygonSoup parse(const std::string& bytes, const std::string& others) {
  if (bytes.empty()) throw MeshProblem{"is empty; the program that should have written it failed"};
  for (const MeshFormat& format : mesh_formats()) {
    if (format.recognises(bytes)) return format.read(bytes);
  }
  const std::string foreign = foreign_format(bytes);
  if (!others.empty() && (!foreign.empty() || bytes.find('\0') == std::string::npos)) {
    throw MeshProblem{"is " + (foreign.empty() ? "text, but no mesh" : foreign) + "; " + others + " or a mesh (" +
                      mesh_format_names() + ") is needed" + foreign_remedy(bytes)};
  }
  if (foreign == "a volume (OpenVDB)") {
    throw MeshProblem{"is a volume (OpenVDB), not a mesh; vam-sdf takes both, vam-slice a mesh"};
  }
  if (!foreign.empty()) {
    throw MeshProblem{"is " + foreign + ", not a mesh; one of " + mesh_format_names() + " is needed" +
                      foreign_remedy(bytes)};
  }
  // A binary STL has no signature; of no other format is anything left but text.
  if (const std::size_t at = bytes.find('\0'); at != std::string::npos) {
    if (const std::string text = text_format_of(bytes); !text.empty())
      throw MeshProblem{"is damaged: byte " + std::to_string(at) + " of its text (" + text + ") is 0; save it again"};
    return parse_stl(bytes);
  }
  throw MeshProblem{"not a mesh of a known format; export the part as one of " + mesh_format_names()};
}

// A pipe may never end: whether nothing that follows makes these first bytes a mesh. No format begins so, and a binary
// STL has ended or exceeds all limits.
bool is_hopeless(const std::string& bytes) {
  const std::string text = without_mark(bytes);
  const std::vector<MeshFormat>& formats = mesh_formats();
  const auto begins = [&](const MeshFormat& format) { return format.recognises(text); };
  if (std::any_of(formats.begin(), formats.end(), begins)) return false;
  const std::uint64_t promised = binary_stl_bytes(bytes);
  return promised < bytes.size() || promised > most_bytes;
}

std::string bytes_of(const std::string& path) {
  InputFile file(path);
  std::string bytes;
  bool looked = false;
  for (auto ready = file.peek(); !ready.empty(); ready = file.peek()) {
    if (bytes.size() + ready.size() > most_bytes) {
      throw Error{Fault::data, file.name() + ": longer than " + in_gib(static_cast<double>(most_bytes)) +
                                   ", the most that is read of a mesh"};
    }
    bytes.append(ready.data(), ready.size());
    file.skip(ready.size());
    if (looked || bytes.size() < first_look) continue;
    looked = true;
    if (is_hopeless(bytes)) break;
  }
  return without_mark(std::move(bytes));
}

// The format of a name that is written.
const MeshFormat& format_of_output(const std::string& path) {
  for (const MeshFormat& format : mesh_formats()) {
    if (format.write != nullptr && (path == "-" ? ".ply" == format.extension : path.ends_with(format.extension)))
      return format;
  }
  throw Error{Fault::usage, path + ": unsupported output format; use " + join(written_mesh_endings(), " or ")};
}

void check_points(const PolygonSoup& soup) {
  constexpr auto limit = static_cast<std::size_t>(std::numeric_limits<int>::max());
  if (soup.points.size() > limit)
    throw MeshProblem{"has " + std::to_string(soup.points.size()) + " vertices, more than 2^31 - 1"};
  for (const float u : soup.uncertainty) {
    if (!std::isfinite(u) || u < 0) throw MeshProblem{"has an uncertainty that is negative or not finite"};
  }
  for (std::size_t i = 0; i < soup.points.size(); ++i) {
    for (const double x : soup.points[i]) {
      if (std::abs(x) <= farthest_point) continue;
      throw MeshProblem{(soup.of_facets ? "facet " + std::to_string(i / 3) + " has a corner that is"
                                        : "vertex " + std::to_string(i) + " is") +
                        (std::isfinite(x) ? " at " + format_number(x, 3) : std::string(" not finite")) +
                        " (counted from 0, of " + std::to_string(soup.points.size() / (soup.of_facets ? 3 : 1)) +
                        "); the file is damaged, save the mesh again"};
    }
  }
}

// A fan per polygon. For a concave one the fan folds over itself, yet every fold cancels in a signed volume.
ColouredMesh triangulated(PolygonSoup&& soup) {
  ColouredMesh made;
  model::TriangleSoup& mesh = made.mesh;
  const int points = count_of(soup.points);
  mesh.triangles.reserve(soup.faces.size());
  for (std::size_t f = 0; f < soup.faces.size(); ++f) {
    const auto& face = soup.faces[f];
    if (face.size() < 3)
      throw MeshProblem{"face " + std::to_string(f) + " has " + std::to_string(face.size()) +
                        " corners; mend it, or save the mesh again"};
    if (face.size() > most_corners) {
      throw MeshProblem{"face " + std::to_string(f) + " has " + std::to_string(face.size()) + " corners; up to " +
                        std::to_string(most_corners) + " are read; cut it into triangles"};
    }
    for (const int corner : face) {
      if (corner < 0 || corner >= points) {
        throw MeshProblem{"face " + std::to_string(f) + " uses vertex " + std::to_string(corner) + " of " +
                          std::to_string(points) + " (counted from 0); mend it, or save the mesh again"};
      }
    }
    for (std::size_t c = 2; c < face.size(); ++c) mesh.triangles.push_back({face[0], face[c - 1], face[c]});
  }
  if (mesh.triangles.empty()) throw MeshProblem{"the mesh is empty: " + std::to_string(points) + " vertices, no face"};
  mesh.points = std::move(soup.points);
  made.colours = std::move(soup.colours);
  made.uncertainty = std::move(soup.uncertainty);
  made.taken_away = soup.taken_away;
  return made;
}

ColouredMesh parsed(const std::string& bytes, const std::string& name, const std::string& others) {
  try {
    PolygonSoup soup = parse(bytes, others);
    check_points(soup);
    return triangulated(std::move(soup));
  } catch (const std::runtime_error& problem) {
    throw Error{Fault::data, name + ": " + problem.what()};
  }
}

auto members(ColouredMesh& made) {
  return std::tie(made.mesh.points, made.mesh.triangles, made.colours, made.uncertainty, made.taken_away);
}

// Once more, as what a child sends is not believed.
void check_indices(const ColouredMesh& made, const std::string& name) {
  const model::TriangleSoup& mesh = made.mesh;
  const int points = count_of(mesh.points);
  const auto whole = [&](const auto& values) { return values.empty() || values.size() == mesh.points.size(); };
  if (!whole(made.colours) || !whole(made.uncertainty) || made.taken_away > mesh.triangles.size())
    throw Error{Fault::data, name + ": is damaged (its parser failed)"};
  for (const auto& triangle : mesh.triangles) {
    for (const int corner : triangle) {
      if (corner < 0 || corner >= points) throw Error{Fault::data, name + ": is damaged (its parser failed)"};
    }
  }
}

}  // namespace

std::string mesh_format_names() {
  std::vector<std::string> names;
  for (const MeshFormat& format : mesh_formats()) names.push_back(format.name);
  return join(names, ", ");
}

std::vector<std::string> written_mesh_endings() {
  std::vector<std::string> endings;
  for (const MeshFormat& format : mesh_formats()) {
    if (format.write != nullptr) endings.push_back(format.extension);
  }
  return endings;
}

void write_mesh(const std::string& path, const model::TriangleSoup& mesh, const std::vector<std::string>& comments) {
  format_of_output(path).write(path, mesh, comments);
}

ColouredMesh read_coloured_mesh(const std::string& path, const std::string& others) {
  const std::string bytes = bytes_of(path);
  const std::string name = input_name(path);
  // These are 50 bytes a triangle and read by code of ours that any bytes will do for; the rest is read apart.
  if (has_binary_stl_size(bytes)) return parsed(bytes, name, others);
  ColouredMesh made;
  read_apart(
      {name, bytes.size()},
      [&](Sender& out) {
        ColouredMesh there = parsed(bytes, name, others);
        out.put(members(there));
      },
      [&](Receiver& in) { in.fill(members(made)); });
  check_indices(made, name);
  made.in_mm = is_3mf(bytes);
  return made;
}

model::TriangleSoup read_mesh(const std::string& path) { return read_coloured_mesh(path).mesh; }

}  // namespace vam::io
