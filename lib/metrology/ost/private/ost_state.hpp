// SPDX-License-Identifier: GPL-3.0-or-later
// The state of a rig, private to the files that use it.
#pragma once

#include <numbers>
#include <span>
#include <vector>

#include "metrology/ost/cleaning_report.hpp"
#include "metrology/ost/ost.hpp"
#include "metrology/ost/private/back_projection.hpp"
#include "metrology/ost/private/camera_sinograms.hpp"
#include "metrology/ost/private/heights.hpp"
#include "optics/resample.hpp"
#include "tomo/radon.hpp"

namespace vam::metrology {

struct OstReconstructor::State {
  OstOptions options;
  AxisPose axis;
  Eye eye;
  optics::Detector detector;  // virtual, pitch = voxel
  double absorption_per_mm = 0;
  double azimuth_rad = 0;
  int direction = 1;
  model::Grid grid;

  [[nodiscard]] tomo::ParallelGeometry geometry(int angles) const {
    return {.nx = grid.nx,
            .ny = grid.ny,
            .columns = detector.columns,
            .angles = angles,
            .axis_x = 0.5 * (grid.nx - 1),
            .axis_y = 0.5 * (grid.ny - 1),
            .angle_start_rad = 0,
            .angle_step_rad = 2 * std::numbers::pi / angles,
            .alpha_per_px = -absorption_per_mm * grid.voxel_mm};
  }

  [[nodiscard]] std::vector<double> heights_mm(int first, int count) const;
  /// Views at these heights, as of a vial in its place in steady light; an empty span means that it is.
  [[nodiscard]] std::vector<Image> steady_views(std::span<const CameraView> views, const RowOfHeight& map,
                                                std::span<const double> heights_mm, double background,
                                                std::span<const double> intensity) const;
  [[nodiscard]] std::vector<Image> virtual_sinograms(std::span<const Image> sinograms,
                                                     std::span<const double> heights_mm) const;
  /// The light of the views, of which `mean` is the mean, over that of the median view. Not determined in absorbing
  /// resin, without refraction, and where the print leaves the image.
  [[nodiscard]] Flicker flicker(std::span<const CameraView> views, const Image& mean,
                                std::span<const double> angles_deg, double background) const;
  /// Motion of the columns of views at these stage angles by a run-out of (x, y) mm in the frame of the part.
  [[nodiscard]] std::vector<ColumnMotion> motion(std::span<const double> angles_deg, double x_mm, double y_mm) const;
  [[nodiscard]] std::vector<double> part_angles_rad(std::span<const double> angles_deg) const;
  /// Turn of the line of each camera column from one column to the next.
  [[nodiscard]] std::vector<double> lean_rad() const;
  [[nodiscard]] ClimbingRays rays(int angles) const;
  [[nodiscard]] int half_width(double voxel_mm) const;
  void clean(std::vector<Image>& sinograms, std::span<const double> heights_mm, double part,
             CleaningReport& found) const;
  void weigh(std::vector<Image>& sinograms, std::span<const double> heights_mm) const;
  void refine_slices(std::span<const Image> sinograms, int first, model::Volume& volume) const;
};

}  // namespace vam::metrology
