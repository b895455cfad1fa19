// SPDX-License-Identifier: GPL-3.0-or-later
// Mesh files: STL, OBJ, PLY, OFF and 3MF in; STL, OBJ, PLY and 3MF out.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "model/mesh.hpp"

namespace vam::io {

/// Reads a mesh; the format is determined by the content, "-" is stdin. Polygons are cut into fans of triangles.
/// Coordinates are those of the file, 3MF's converted to mm by its unit. Nothing is welded or repaired. Throws Error:
/// no_input, io, data (unknown format, truncated, no triangle, a vertex that is not finite, a face with an index that
/// does not exist or with fewer than three corners or more than 65536).
[[nodiscard]] model::TriangleSoup read_mesh(const std::string& path);

/// The same, with what PLY has of its vertices: colours, and standard uncertainties (scalar_uncertainty, mm). Throws
/// also for an uncertainty that is negative or not finite. `others`, "a volume (VDB)": what else the caller reads, for
/// the message about a file that is no mesh.
struct ColouredMesh {
  model::TriangleSoup mesh;
  std::vector<std::array<std::uint8_t, 3>> colours;  // one a point, or none
  std::vector<float> uncertainty;                    // the same
  std::size_t taken_away = 0;                        // last triangles, around what a slicer takes away from the rest
  bool in_mm = false;                                // the file states its unit, which was converted
};
[[nodiscard]] ColouredMesh read_coloured_mesh(const std::string& path, const std::string& others = "");

/// The formats that are read, for messages and help: "3MF, PLY, ...".
[[nodiscard]] std::string mesh_format_names();

/// The endings that write_mesh() knows: ".ply", ...
[[nodiscard]] std::vector<std::string> written_mesh_endings();

/// Writes the format of the file name's extension, PLY to "-"; comments go where the format has some.
/// Throws Error: usage (an ending that is not written), no_output, io.
void write_mesh(const std::string& path, const model::TriangleSoup& mesh, const std::vector<std::string>& comments);

/// Writes binary STL (32-bit floats). "-" is stdout. Throws Error: no_output, io.
void write_stl(const std::string& path, const model::TriangleSoup& mesh);

/// Writes binary little-endian PLY with 32-bit floats; a soup without triangles is a point cloud. Quality goes into
/// both `quality`, which MeshLab reads, and `scalar_distance`, which CloudCompare reads, uncertainties into
/// `scalar_uncertainty`, colours into `red green blue`.
/// Each of `comments` becomes a comment line. "-" is stdout. Throws Error: no_output, io.
void write_ply(const std::string& path, const model::TriangleSoup& mesh, const model::VertexData& vertices = {},
               const std::vector<std::string>& comments = {});

}  // namespace vam::io
