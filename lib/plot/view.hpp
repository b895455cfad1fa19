// SPDX-License-Identifier: GPL-3.0-or-later
// What vam-view shows of each kind of file.
#pragma once

#include <optional>
#include <string>

#include "io/image/any_frames.hpp"
#include "io/vdb/vdb.hpp"
#include "model/circle.hpp"
#include "plot/image_figure.hpp"
#include "plot/planes.hpp"
#include "plot/plot.hpp"

namespace vam::plot {

struct ViewOptions {
  std::string name;                       // of the file, for titles
  std::optional<std::string> title = {};  // of the figure, instead of one that says what is seen
  Plane plane = Plane::axial;
  double stretch_z = 1;  // of the volume or sinograms along z (vam:stretch_z): its z / stretch_z is mm in the print
  std::optional<double>
      at;         // mm in the print across the plane; z of a slice in mm or stage angle of a frame in degrees
  int sheet = 1;  // number of images, evenly spread
  std::optional<double> low;  // values of the ends of the colours
  std::optional<double> high;
  std::optional<double> critical;  // dose from which on the resin gels, marked where doses are told
  std::string colours = "auto";    // auto, grey, viridis, diverging
  int size = 720;
  bool crop = true;  // sinograms to the columns that are lit
};

/// Sections of a volume: the middle one, the one at `at`, or a sheet. With a target its outline is drawn, and
/// an insert on the grid of the volume is hatched, with its shadow.
[[nodiscard]] ImageFigure view_volume(const io::SparseVolume& volume, const io::SparseVolume* target,
                                      const ViewOptions& options, const io::SparseVolume* insert = nullptr);

/// Images of a stack: the middle slice of sinograms, the first frame of frames, the nearest to `at`, or a sheet. Throws
/// Fault::data when `at` is given and the images have no such coordinate.
[[nodiscard]] ImageFigure view_images(io::ImageSource& images, const ViewOptions& options);

/// What prints where the dose reaches the threshold: cured as wanted, missing, overcured. Voxels that the surface cuts
/// are right either way, but for those of a wall that is lost, cut or missing (missing.hpp). Without `at` and a sheet
/// it is a section in which much is missing, if any. Void outside the writable circle is shown, but does not count. An
/// insert is hatched, and does not count. Throws Fault::data when the grids differ.
[[nodiscard]] ImageFigure view_cure(const io::SparseVolume& dose, const io::SparseVolume& target, double threshold,
                                    const model::Circle& circle, const ViewOptions& options,
                                    const io::SparseVolume* insert = nullptr);

/// A volume beside others, and its name.
struct OtherVolume {
  const io::SparseVolume* volume;
  std::string name;
};
/// Each section of all volumes, and by how much the others are more than the first. With a target its outline is drawn.
/// Throws Fault::data when the grids differ.
[[nodiscard]] ImageFigure view_difference(const io::SparseVolume& volume, const std::vector<OtherVolume>& others,
                                          const io::SparseVolume* target, const ViewOptions& options);

/// Of sections of a volume on the grid of the target only the part and a margin.
void crop_to_part(ImageFigure& figure, const io::SparseVolume& target, Plane plane);

/// Throws Fault::data when the voxels of `grid`, which `name` has, are not those of the other.
void require_same_voxels(const model::Grid& grid, const model::Grid& other, const std::string& name,
                         const std::string& remedy);

/// Shares of the voxels inside and outside the part over the dose [OST22 fig S6 c, f, i], with the lowest dose inside
/// and the highest outside. Voxels that the surface cuts, those outside the writable circle, and those
/// that an insert on the same grid covers at least half, which are no resin, are left out. Throws Fault::data when the
/// grids differ, or there is no voxel inside or outside.
[[nodiscard]] Plot dose_histogram(const io::SparseVolume& dose, const io::SparseVolume& target,
                                  const model::Circle& circle, const ViewOptions& options,
                                  const io::SparseVolume* insert = nullptr);

}  // namespace vam::plot
