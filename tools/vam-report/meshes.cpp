// SPDX-License-Identifier: GPL-3.0-or-later
#include "vam-report/meshes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>

#include "plot/page.hpp"
#include "session/surface.hpp"
#include "solid/mesh/geometry.hpp"
#include "vam-report/layers.hpp"
#include "vam-report/page_parts.hpp"

namespace vam::report_tool {

namespace {

/// The vertices of each cell as their mean; triangles within a cell are left out.
ShownMesh clustered(const ShownMesh& fine, double cell_mm) {
  struct Sum {
    int index;
    Vector3 place{};
    std::array<double, 3> colour{};
    double count = 0;
  };
  std::map<std::array<std::int64_t, 3>, Sum> cells;
  std::vector<int> cell_of;
  for (std::size_t n = 0; n < fine.mesh.points.size(); ++n) {
    std::array<std::int64_t, 3> key{};
    for (std::size_t a = 0; a < 3; ++a) key[a] = std::llround(fine.mesh.points[n][a] / cell_mm);
    Sum& sum = cells.try_emplace(key, Sum{static_cast<int>(cells.size())}).first->second;
    sum.place = sum.place + fine.mesh.points[n];
    for (std::size_t c = 0; c < 3 && !fine.colours.empty(); ++c) sum.colour[c] += fine.colours[n][c];
    sum.count += 1;
    cell_of.push_back(sum.index);
  }
  ShownMesh coarse{fine.name, {}, {}};
  coarse.mesh.points.resize(cells.size());
  if (!fine.colours.empty()) coarse.colours.resize(cells.size());
  for (const auto& [key, sum] : cells) {
    coarse.mesh.points[sum.index] = (1 / sum.count) * sum.place;
    for (std::size_t c = 0; c < 3 && !fine.colours.empty(); ++c) {
      coarse.colours[sum.index][c] = static_cast<std::uint8_t>(std::lround(sum.colour[c] / sum.count));
    }
  }
  for (const auto& [a, b, c] : fine.mesh.triangles) {
    const std::array<int, 3> t{cell_of[a], cell_of[b], cell_of[c]};
    if (t[0] != t[1] && t[1] != t[2] && t[2] != t[0]) coarse.mesh.triangles.push_back(t);
  }
  return coarse;
}

ShownMesh shown(const ShownMesh& mesh) {
  if (mesh.mesh.points.size() <= most_vertices) return mesh;
  double cell_mm = solid::bounding_box(mesh.mesh).largest_side() / 200;
  ShownMesh coarse = clustered(mesh, cell_mm);
  while (coarse.mesh.points.size() > most_vertices) coarse = clustered(mesh, cell_mm *= 1.3);
  return coarse;
}

}  // namespace

std::vector<ShownMesh> read_meshes(const std::vector<std::string>& paths) {
  std::vector<ShownMesh> meshes;
  for (const std::string& path : paths) {
    io::ColouredMesh read = session::read_solid(path);
    meshes.push_back({file_name(path), std::move(read.mesh), std::move(read.colours)});
  }
  std::stable_sort(meshes.begin(), meshes.end(),
                   [](const ShownMesh& a, const ShownMesh& b) { return !a.colours.empty() && b.colours.empty(); });
  return meshes;
}

std::string meshes_view(const std::vector<ShownMesh>& meshes, std::optional<double> limit_mm) {
  std::vector<Layer> layers;
  for (const ShownMesh& mesh : meshes) {
    ShownMesh seen = shown(mesh);
    Layer layer{seen.name, std::move(seen.mesh), {}, 1, "mm", "", std::move(seen.colours)};
    if (!layer.colours.empty() && limit_mm) {
      layer.limit = *limit_mm;
      layer.meaning = "distance of the print from the design; red: outside, blue: missing";
    }
    if (!layer.mesh.triangles.empty()) layers.push_back(std::move(layer));
  }
  if (layers.empty()) return "";
  return plot::page_figure("Print and design", layers_view(layers, "mesh"),
                           "Drag to rotate, scroll to zoom; z points upwards.");
}

}  // namespace vam::report_tool
