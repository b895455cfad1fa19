// SPDX-License-Identifier: GPL-3.0-or-later
// Binary PLY with the per-vertex scalars and colours that MeshLab and CloudCompare show.
#include <cstdint>
#include <cstring>

#include "io/mesh/file.hpp"
#include "io/stream/stream.hpp"

namespace vam::io {

namespace {

std::string ply_header(const model::TriangleSoup& mesh, const model::VertexData& vertices,
                       const std::vector<std::string>& comments) {
  std::string header = "ply\nformat binary_little_endian 1.0\n";
  for (std::string comment : comments) {
    for (char& c : comment) c = c == '\n' || c == '\r' ? ' ' : c;
    header += "comment " + comment + "\n";
  }
  header += "element vertex " + std::to_string(mesh.points.size()) + "\n";
  header += "property float x\nproperty float y\nproperty float z\n";
  if (!vertices.quality.empty()) header += "property float quality\nproperty float scalar_distance\n";
  if (!vertices.uncertainty.empty()) header += "property float scalar_uncertainty\n";
  if (!vertices.colours.empty()) header += "property uchar red\nproperty uchar green\nproperty uchar blue\n";
  header += "element face " + std::to_string(mesh.triangles.size()) + "\nproperty list uchar int vertex_indices\n";
  return header + "end_header\n";
}

}  // namespace

void write_ply(const std::string& path, const model::TriangleSoup& mesh, const model::VertexData& vertices,
               const std::vector<std::string>& comments) {
  OutputFile file(path);
  file.write(ply_header(mesh, vertices, comments));
  for (std::size_t i = 0; i < mesh.points.size(); ++i) {
    float record[6];
    std::size_t floats = 0;
    for (const double x : mesh.points[i]) record[floats++] = static_cast<float>(x);
    if (!vertices.quality.empty()) {
      record[floats++] = vertices.quality[i];
      record[floats++] = vertices.quality[i];
    }
    if (!vertices.uncertainty.empty()) record[floats++] = vertices.uncertainty[i];
    file.write(record, floats * sizeof record[0]);
    if (!vertices.colours.empty()) file.write(vertices.colours[i].data(), 3);
  }
  for (const auto& triangle : mesh.triangles) {
    const std::uint8_t corners = 3;
    const std::int32_t indices[3] = {triangle[0], triangle[1], triangle[2]};
    file.write(&corners, 1);
    file.write(indices, sizeof indices);
  }
  file.commit();
}

}  // namespace vam::io
