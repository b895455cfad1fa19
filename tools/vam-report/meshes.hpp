// SPDX-License-Identifier: GPL-3.0-or-later
// Meshes on a page: a print that vam-sdf measured, and its design.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/pixels.hpp"
#include "model/mesh.hpp"
#include "vam-report/inspection.hpp"

namespace vam::report_tool {

/// A mesh of the page. One with colours is the print, in the colours of its deviation.
struct ShownMesh {
  std::string name;
  model::TriangleSoup mesh;
  std::vector<Rgb> colours;
};
[[nodiscard]] std::vector<ShownMesh> read_meshes(const std::vector<std::string>& paths);

/// HTML: the meshes as bodies that can be turned, of at most 60,000 vertices each: beyond, those in a cell become one.
/// `limit_mm`: of the colours, if it is known.
[[nodiscard]] std::string meshes_view(const std::vector<ShownMesh>& meshes, std::optional<double> limit_mm);

/// HTML: sections through the middle of the first mesh, across x, y and z, all meshes in one, with their dimensions.
/// `errors`: of the first mesh, if they are known.
[[nodiscard]] std::string mesh_sections(const std::vector<ShownMesh>& meshes,
                                        const std::optional<DimensionErrors>& errors);

}  // namespace vam::report_tool
