// SPDX-License-Identifier: GPL-3.0-or-later
#include "vam-report/body.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/text/text.hpp"
#include "model/dose/dose_metrics.hpp"
#include "model/grid.hpp"
#include "model/mesh.hpp"
#include "model/metadata.hpp"
#include "model/value_at.hpp"
#include "plot/missing.hpp"
#include "plot/page.hpp"
#include "solid/mesh/geometry.hpp"
#include "solid/mesh/signed_distance.hpp"
#include "solid/voxel/isosurface.hpp"
#include "vam-report/layers.hpp"

namespace vam::report_tool {

namespace {

constexpr std::size_t most_voxels = 2'000'000;

/// Means of by x by x by voxels; beyond the volume is nothing.
model::Volume averaged(const io::SparseVolume& volume, int by) {
  const model::Grid& fine = volume.grid();
  const auto fewer = [by](int count) { return (count + by - 1) / by; };
  const double shift_mm = 0.5 * (by - 1) * fine.voxel_mm;
  model::Volume coarse{{fewer(fine.nx), fewer(fine.ny), fewer(fine.nz), by * fine.voxel_mm, fine.origin_mm}, {}};
  for (double& origin : coarse.grid.origin_mm) origin += shift_mm;
  coarse.values.resize(coarse.grid.size());
  const float share = 1.0F / static_cast<float>(by * by * by);
  std::vector<float> slice(fine.slice_size());
  for (int k = 0; k < fine.nz; ++k) {
    volume.read_slices(k, 1, slice.data());
    float* out = coarse.slice(k / by);
    for (int j = 0; j < fine.ny; ++j) {
      const float* row = slice.data() + static_cast<std::size_t>(j) * static_cast<std::size_t>(fine.nx);
      float* sums = out + static_cast<std::size_t>(j / by) * static_cast<std::size_t>(coarse.grid.nx);
      for (int i = 0; i < fine.nx; ++i) sums[i / by] += share * row[i];
    }
  }
  return coarse;
}

/// The border's value beyond it.
double value_at(const model::Volume& volume, const Vector3& point) {
  const model::Grid& g = volume.grid;
  return static_cast<double>(model::value_at(volume, std::clamp(point[0], g.x_mm(0), g.x_mm(g.nx - 1)),
                                             std::clamp(point[1], g.y_mm(0), g.y_mm(g.ny - 1)),
                                             std::clamp(point[2], g.z_mm(0), g.z_mm(g.nz - 1))));
}

/// The 98th percentile of the magnitudes as a number with one digit.
double colour_limit(std::vector<double> values, double least) {
  for (double& value : values) value = std::abs(value);
  if (values.empty()) return least;
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(0.98 * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  const double wanted = std::max(least, *at);
  const double power = std::pow(10, std::floor(std::log10(wanted)));
  return std::ceil(wanted / power) * power;
}

/// With the triangles of another mesh.
void append(model::TriangleSoup& mesh, const model::TriangleSoup& other) {
  const auto first = static_cast<decltype(mesh.triangles)::value_type::value_type>(mesh.points.size());
  mesh.points.insert(mesh.points.end(), other.points.begin(), other.points.end());
  for (auto triangle : other.triangles) {
    for (auto& corner : triangle) corner += first;
    mesh.triangles.push_back(triangle);
  }
}

/// Walls thinner than half a voxel, which the surface of the coverage leaves out; of a print, those that do not cure.
model::TriangleSoup lost_body(const io::SparseVolume& target, const PrintedDose* print, int by) {
  const io::SparseVolume lost =
      plot::lost_wall_volume(target, print != nullptr ? print->dose : nullptr, print != nullptr ? print->threshold : 0);
  return solid::isosurface(averaged(lost, by), 0.5 / by);  // of one voxel, which is a share of 1/by in a wall
}

/// The design, and the print where there is a dose, on voxels of this coarseness.
std::vector<Layer> layers_of(const io::SparseVolume& target, const std::optional<PrintedDose>& print, int by) {
  std::vector<Layer> layers(1);
  layers[0].name = "design";
  layers[0].mesh = solid::isosurface(averaged(target, by), model::half_surface);
  Layer& design = layers[0];
  const bool shows = !design.mesh.triangles.empty();
  const model::TriangleSoup resolved = design.mesh;
  append(design.mesh, lost_body(target, nullptr, by));
  if (!print || design.mesh.triangles.empty()) return layers;
  const model::Volume dose = averaged(*print->dose, by);
  for (const auto& point : design.mesh.points)
    design.values.push_back(100 * (value_at(dose, point) / print->threshold - 1));
  design.limit = colour_limit(design.values, 1);
  design.unit = "%";
  design.meaning = "dose on the design's surface relative to the threshold; blue: too low";
  Layer printed{"print", solid::fine_isosurface(dose, print->threshold), {}, 1, "mm", ""};
  if (printed.mesh.triangles.empty() || !shows) return layers;
  const std::vector<float> away = solid::Surface(resolved).signed_distances(printed.mesh.points);
  printed.values.assign(away.begin(), away.end());
  printed.limit = colour_limit(printed.values, 0.1 * target.grid().voxel_mm);
  printed.meaning = "distance of the print from the design; red: outside, blue: missing";
  append(printed.mesh, lost_body(target, &*print, by));
  printed.values.resize(printed.mesh.points.size(), -printed.limit);  // missing
  layers.push_back(std::move(printed));
  return layers;
}

std::size_t vertices(const std::vector<Layer>& layers) {
  std::size_t most = 0;
  for (const Layer& layer : layers) most = std::max(most, layer.mesh.points.size() + layer.beside.points.size());
  return most;
}

void add_insert(std::vector<Layer>& layers, const io::SparseVolume* insert, int by) {
  if (insert == nullptr) return;
  const model::TriangleSoup body = solid::isosurface(averaged(*insert, by), model::half_surface);
  for (Layer& layer : layers) layer.beside = body;
}

}  // namespace

std::string body_view(const io::SparseVolume& target, const std::optional<PrintedDose>& print,
                      const io::SparseVolume* insert) {
  int by = 1;
  while (target.grid().size() / static_cast<std::size_t>(by * by * by) > most_voxels) ++by;
  std::vector<Layer> layers;
  for (;; ++by) {
    layers = layers_of(target, print, by);
    add_insert(layers, insert, by);
    if (vertices(layers) <= most_vertices) break;
  }
  if (layers[0].mesh.triangles.empty()) return "";
  for (Layer& layer : layers) {
    model::unstretch(layer.mesh, target.metadata);
    model::unstretch(layer.beside, target.metadata);
  }
  const solid::Bounds design = solid::bounding_box(layers[0].mesh);
  const Vector3 size = design.high - design.low;
  const std::string mm =
      format_number(size[0], 3) + " x " + format_number(size[1], 3) + " x " + format_number(size[2], 3) + " mm";
  const std::string voxel = format_number(by * target.grid().voxel_mm, 3) + " mm";
  return plot::page_figure(
      "Part and print", layers_view(layers, "layer"),
      "Drag to rotate, scroll to zoom; the rotation axis z points upwards. The design's surface, where voxels of " +
          voxel + " are half covered, spans " + mm +
          " along x, y and z, as it is to be printed, to within such a voxel." +
          (layers.size() > 1 ? " The print's is where the dose, averaged over such voxels, reaches the threshold."
                             : "") +
          (layers[0].beside.triangles.empty() ? "" : " The insert is green."));
}

}  // namespace vam::report_tool
