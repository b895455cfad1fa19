// SPDX-License-Identifier: GPL-3.0-or-later
// The table of mesh formats, and how each is recognised by its content.
#include "io/mesh/private/formats.hpp"

#include <algorithm>
#include <cstdio>
#include <string_view>

#include "base/printable.hpp"
#include "base/text.hpp"
#include "io/mesh/file.hpp"
#include "io/stream/stream.hpp"

namespace vam::io {

namespace {

bool is_binary(const std::string& bytes) { return bytes.find('\0') != std::string::npos; }

std::string_view trimmed(const std::string& bytes) {
  return std::string_view(bytes).substr(std::min(bytes.find_first_not_of(" \t\r\n"), bytes.size()));
}

bool starts_with_word(std::string_view text, std::string_view word) {
  return text.starts_with(word) && text.size() > word.size() &&
         std::string_view(" \t\r\n").find(text[word.size()]) != text.npos;
}

// A line of an OBJ file that nothing else has: "v x y z" or "f a b c" at its start.
bool is_obj(const std::string& bytes) {
  if (is_binary(bytes)) return false;
  const std::string_view head = std::string_view(bytes).substr(0, 1 << 16);
  for (std::size_t line = 0; line < head.size();) {
    if (starts_with_word(head.substr(line), "v") || starts_with_word(head.substr(line), "f")) return true;
    const std::size_t end = head.find('\n', line);
    if (end == std::string_view::npos) return false;
    line = end + 1;
  }
  return false;
}

bool is_off(const std::string& bytes) {
  for (const char* magic : {"OFF", "COFF", "NOFF", "CNOFF", "STOFF"}) {
    if (starts_with_word(trimmed(bytes), magic)) return true;
  }
  return false;
}

bool is_ply(const std::string& bytes) { return starts_with_word(bytes, "ply"); }

// ASCII STL; some programs write it in capitals.
bool is_text_stl(const std::string& bytes) {
  return !is_binary(bytes) && starts_with_word(lower_case(std::string(trimmed(bytes).substr(0, 8))), "solid");
}

// The size comes before "solid": many programs begin the header of a binary STL with that word.
bool is_stl(const std::string& bytes) { return has_binary_stl_size(bytes) || is_text_stl(bytes); }

bool has_vertex_line(const std::string& text) {
  for (std::size_t line = 0; line < text.size(); line = std::min(text.find('\n', line), text.size()) + 1) {
    double x = 0, y = 0, z = 0;
    if (text[line] == 'v' && std::sscanf(text.c_str() + line, "v %lf %lf %lf", &x, &y, &z) == 3) return true;
  }
  return false;
}

void write_plain_ply(const std::string& path, const model::TriangleSoup& mesh,
                     const std::vector<std::string>& comments) {
  write_ply(path, mesh, {}, comments);
}

void write_plain_stl(const std::string& path, const model::TriangleSoup& mesh, const std::vector<std::string>&) {
  write_stl(path, mesh);
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
      {".3mf", "3MF", is_3mf, parse_3mf, write_3mf},       {".ply", "PLY", is_ply, parse_ply, write_plain_ply},
      {".stl", "STL", is_stl, parse_stl, write_plain_stl}, {".off", "OFF", is_off, parse_off, nullptr},
      {".obj", "OBJ", is_obj, parse_obj, write_obj},
  };
  return formats;
}

}  // namespace vam::io
