// SPDX-License-Identifier: GPL-3.0-or-later
// The table of mesh formats, and how each is recognised by its content.
#include "io/mesh/private/formats.hpp"

#include <algorithm>
#include <string_view>

#include "base/text/printable.hpp"
#include "base/text/text.hpp"
#include "io/mesh/file.hpp"
#include "io/mesh/private/text.hpp"
#include "io/stream/stream.hpp"

namespace vam::io {

namespace {

bool is_binary(const std::string& bytes) { return bytes.find('\0') != std::string::npos; }

/// With a blank behind it; empty where there is none.
std::string_view first_word(std::string_view text) {
  text = text.substr(0, 1 << 16);
  const std::string_view word = take_word(text);
  return text.empty() ? text : word;
}

// A line of an OBJ file that nothing else has: "v x y z" or "f a b c" at its start.
bool is_obj(const std::string& bytes) {
  if (is_binary(bytes)) return false;
  for (Lines lines{std::string_view(bytes).substr(0, 1 << 16)}; lines.next();) {
    const std::string_view line = lines.line.substr(0, 2);
    if (line == "v " || line == "f " || line == "v\t" || line == "f\t") return true;
  }
  return false;
}

bool is_off(const std::string& bytes) {
  const std::string_view word = first_word(bytes);
  return word == "OFF" || word == "COFF" || word == "NOFF" || word == "CNOFF" || word == "STOFF";
}

bool is_ply(const std::string& bytes) { return bytes.starts_with("ply") && first_word(bytes) == "ply"; }

// ASCII STL; some programs write it in capitals.
bool is_text_stl(const std::string& bytes) {
  return !is_binary(bytes) && lower_case(std::string(first_word(bytes))) == "solid";
}

// The size comes before "solid": many programs begin the header of a binary STL with that word.
bool is_stl(const std::string& bytes) { return has_binary_stl_size(bytes) || is_text_stl(bytes); }

bool has_vertex_line(const std::string& text) {
  for (Lines lines{text}; lines.next();) {
    std::string_view line = lines.line;
    if (take_word(line) == "v" && take_point(line)) return true;
  }
  return false;
}

void write_obj(const std::string& path, const model::TriangleSoup& mesh, const std::vector<std::string>& comments) {
  OutputFile file(path);
  for (const std::string& comment : comments) file.write("# " + printable(comment) + "\n");
  for (const auto& point : mesh.points) {
    std::string line = "v";
    for (const double x : point) line += " " + format_number(x, 9);
    file.write(line + "\n");
  }
  for (const auto& triangle : mesh.triangles) {
    std::string line = "f";
    for (const int corner : triangle) line += " " + std::to_string(corner + 1);
    file.write(line + "\n");
  }
  file.commit();
}

}  // namespace

std::string text_format_of(const std::string& bytes) {
  std::string text = bytes.substr(0, 1 << 16);
  std::replace(text.begin(), text.end(), '\0', ' ');
  if (is_text_stl(text) && lower_case(text).find("vertex") != std::string::npos) return "ASCII STL";
  return is_obj(text) && has_vertex_line(text) ? "OBJ" : "";
}

bool is_3mf(const std::string& bytes) { return bytes.starts_with("PK\3\4"); }

void require_all_read(std::uint64_t promised, std::uint64_t found) {
  if (found <= promised) return;
  throw MeshProblem{"the header states " + std::to_string(promised) + " faces but the file has " +
                    std::to_string(found) + "; its count is damaged, or it holds several meshes"};
}

void require_count(std::uint64_t count, const char* what, const std::string& bytes) {
  if (count <= bytes.size() / 2) return;
  throw MeshProblem{"the header states " + std::to_string(count) + " " + what + " but the file has " +
                    std::to_string(bytes.size()) + " bytes; it is truncated or damaged"};
}

void give_up(const char* format, const PolygonSoup& soup) {
  throw MeshProblem{std::string("not a whole ") + format + " file: reading stopped after " +
                    std::to_string(soup.points.size()) + " vertices and " + std::to_string(soup.faces.size()) +
                    " faces; it is truncated or damaged"};
}

const std::vector<MeshFormat>& mesh_formats() {
  static const std::vector<MeshFormat> formats{
      {".3mf", "3MF", is_3mf, parse_3mf, write_3mf},
      {".ply", "PLY", is_ply, parse_ply,
       [](const auto& path, const auto& mesh, const auto& comments) { write_ply(path, mesh, {}, comments); }},
      {".stl", "STL", is_stl, parse_stl,
       [](const auto& path, const auto& mesh, const auto&) { write_stl(path, mesh); }},
      {".off", "OFF", is_off, parse_off, nullptr},
      {".obj", "OBJ", is_obj, parse_obj, write_obj},
  };
  return formats;
}

}  // namespace vam::io
