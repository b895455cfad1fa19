// SPDX-License-Identifier: GPL-3.0-or-later
#include "vam-report/volumes.hpp"

#include <algorithm>
#include <utility>

#include "facts.hpp"
#include "io/vdb/gate.hpp"
#include "plot/page.hpp"
#include "plot/view.hpp"
#include "vam-report/names.hpp"
#include "vam-report/series.hpp"

namespace vam::report_tool {

namespace {

constexpr int shown_px = 400;

std::string sections(const io::SparseVolume& volume, const std::string& file, const io::SparseVolume* target,
                     plot::Plane plane, int count) {
  plot::ViewOptions options;
  options.name = file;
  options.plane = plane;
  options.sheet = std::min(count, plot::plane_count(volume.grid(), plane));
  options.size = shown_px;
  options.stretch_z = tool::stretch_z(volume.metadata);
  const plot::PlaneAxes axes = plot::plane_axes(plane);
  const std::string title = volume.name() + ", sections across " + axes.across;
  return series(title, frames_of(plot::view_volume(volume, target, options)), file + ": grid '" + volume.name() + "'.");
}

}  // namespace

const io::SparseVolume* Volumes::find(const std::string& name) const {
  for (const io::SparseVolume& grid : grids) {
    if (grid.name() == name) return &grid;
  }
  return nullptr;
}

Volumes read_volumes(const std::vector<std::string>& paths) {
  Volumes all;
  for (const std::string& path : paths) {
    std::vector<io::SparseVolume> read = io::read_volumes(path);
    io::require_usable(path, read);
    for (io::SparseVolume& grid : read) {
      all.files.push_back(file_name(path));
      all.grids.push_back(std::move(grid));
    }
  }
  const io::SparseVolume* dose = all.find("dose");
  if (dose == nullptr) return all;
  for (std::size_t i = 0; i < all.grids.size(); ++i) {
    if (all.grids[i].name() == "target") {
      all.grids[i].extend_to(dose->grid(), all.files[i]);
      break;
    }
  }
  return all;
}

std::string section_views(const Volumes& volumes, int count) {
  std::string views;
  for (std::size_t n = 0; n < volumes.grids.size(); ++n) {
    const io::SparseVolume& volume = volumes.grids[n];
    const io::SparseVolume* target = volume.name() == "dose" ? volumes.find("target") : nullptr;
    views += sections(volume, volumes.files[n], target, plot::Plane::axial, count);
    views += sections(volume, volumes.files[n], target, plot::Plane::coronal, (count + 1) / 2);
  }
  return views;
}

std::string histogram(const io::SparseVolume& dose, const io::SparseVolume& target, const score::ScoreOptions& how) {
  plot::ViewOptions options;
  options.name = "dose";
  return plot::page_figure(
      "Dose in part and void",
      plot::page_plot(plot::dose_histogram(dose, target, how.circle, options), "histogram of the dose"),
      "If the distributions overlap, no threshold separates part and void. Voxels that the surface cuts are excluded.");
}

}  // namespace vam::report_tool
