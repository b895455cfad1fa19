// SPDX-License-Identifier: GPL-3.0-or-later
#include "vam-report/volumes.hpp"

#include <algorithm>
#include <utility>

#include "base/text/printable.hpp"
#include "model/metadata.hpp"
#include "plot/page.hpp"
#include "plot/view.hpp"
#include "vam-report/page_parts.hpp"

namespace vam::report_tool {

namespace {

constexpr int shown_px = 400;

/// Marks on the sections of a volume; null for none.
struct SectionOverlays {
  std::optional<double> critical;  // dose
  const io::SparseVolume* target = nullptr;
  const io::SparseVolume* insert = nullptr;
};

plot::ViewOptions options_for(const io::SparseVolume& volume, const std::string& name, plot::Plane plane, int count) {
  plot::ViewOptions options;
  options.name = name;
  options.plane = plane;
  options.sheet = std::min(count, plot::plane_count(volume.grid(), plane));
  options.size = shown_px;
  options.stretch_z = model::stretch_z(volume.metadata);
  return options;
}

std::string sections(const io::SparseVolume& volume, const std::string& file, const SectionOverlays& within,
                     plot::Plane plane, int count) {
  plot::ViewOptions options = options_for(volume, file, plane, count);
  options.critical = within.critical;
  const plot::PlaneAxes axes = plot::plane_axes(plane);
  const std::string title = volume.name() + ", sections across " + axes.across;
  return series(title, frames_of(plot::view_volume(volume, within.target, options, within.insert)),
                file + ": grid " + excerpt(volume.name()) +
                    (within.critical ? "; red on the colour bar: the critical dose." : "."));
}

}  // namespace

Volumes read_volumes(const std::vector<std::string>& paths, io::TargetKind kind) {
  Volumes all;
  for (const std::string& path : paths) {
    std::vector<io::SparseVolume> grids = session::read_grids(path, kind);
    for (io::SparseVolume& grid : grids) {
      all.files.push_back(file_name(path));
      all.grids.push_back(std::move(grid));
    }
  }
  const io::SparseVolume* dose = all.find("dose");
  if (dose == nullptr) return all;
  for (const char* name : {"target", "insert"}) {
    io::SparseVolume* grid = session::find_grid(all.grids, name);
    if (grid != nullptr) grid->extend_to(dose->grid(), all.files[grid - all.grids.data()]);
  }
  return all;
}

std::string section_views(const Volumes& volumes, int count, bool outlined, std::optional<double> critical) {
  std::string views;
  for (std::size_t n = 0; n < volumes.grids.size(); ++n) {
    const io::SparseVolume& volume = volumes.grids[n];
    SectionOverlays within;
    if (volume.name() == "dose") within.critical = critical;
    if (outlined && volume.name() == "dose") within.target = volumes.find("target");
    const io::SparseVolume* insert = volumes.find("insert");
    const bool around = volume.name() == "dose" || volume.name() == "target";
    if (around && insert != nullptr && insert->grid() == volume.grid()) within.insert = insert;
    views += sections(volume, volumes.files[n], within, plot::Plane::axial, count);
    const int with_axis = count / 2 / 2 * 2 + 1;  // of an odd number the middle one
    views += sections(volume, volumes.files[n], within, plot::Plane::coronal, with_axis);
  }
  return views;
}

std::string cure_views(const Volumes& volumes, const score::ScoreOptions& how, double threshold, int count) {
  const io::SparseVolume& dose = *volumes.find("dose");
  const io::SparseVolume* insert = volumes.find("insert");
  const plot::ImageFigure sheet = plot::view_cure(dose, *volumes.find("target"), threshold, how.circle,
                                                  options_for(dose, "dose", plot::Plane::axial, count), insert);
  return series("Part as printed, sections across z", frames_of(sheet), "The shares are of all sections.");
}

std::string histogram(const Volumes& volumes, const score::ScoreOptions& how) {
  const io::SparseVolume& dose = *volumes.find("dose");
  const io::SparseVolume* insert = volumes.find("insert");
  plot::ViewOptions options;
  options.name = "dose";
  options.critical = how.threshold;
  return plot::page_figure(
      "Dose in part and void",
      plot::page_plot(plot::dose_histogram(dose, *volumes.find("target"), how.circle, options, insert),
                      "histogram of the dose"),
      "If the distributions overlap, no threshold separates part and void. Voxels that the surface cuts are excluded" +
          std::string(insert == nullptr ? "." : ", and those of the insert, which are no resin."));
}

}  // namespace vam::report_tool
