// SPDX-License-Identifier: GPL-3.0-or-later
// The projector's chief rays in the resin of a simulated vial, and how an image of it lights them.
#pragma once

#include <vector>

#include "base/pixels.hpp"
#include "sim/bench/private/ray.hpp"

namespace vam::sim {

/// All rays from one grazing ray to the other, whether the projector has columns there or not, in thin sheets between
/// neighbours. Near grazing they cross each other inside the resin; each sheet is followed by itself.
class SimBeams {
 public:
  explicit SimBeams(const model::Printer& printer);
  /// Projector columns (fractional) between which the sheets are; one more than there are sheets.
  [[nodiscard]] const std::vector<double>& columns() const { return columns_; }
  /// Where a line of sight crosses a sheet: `path_mm` of it times the sheet's irradiance, of that in the plane of the
  /// axis without a vial, at y_mm along the light.
  struct Crossing {
    double path_mm = 0;
    double y_mm = 0;
  };
  /// For each sheet, along a line of sight that is turned by `azimuth_rad` against the light.
  [[nodiscard]] std::vector<Crossing> along(const SimRay& sight, double azimuth_rad) const;

 private:
  double pixel_mm_;
  double radius_mm_;  // of the resin
  double absorption_per_mm_;
  std::vector<double> columns_;
  std::vector<SimRay> rays_;
};

/// Running sum of the light over a projector row: what falls between two fractional columns is a difference.
class LitRow {
 public:
  explicit LitRow(const std::vector<double>& light);
  /// Mean over from ... to; dark beyond the row's ends.
  [[nodiscard]] double mean(double from, double to) const;

 private:
  [[nodiscard]] double upto(double column) const;  // integral over columns -0.5 ... column
  std::vector<double> sum_;
};

/// An image as light: (grey / full)^gamma, blurred to different widths.
class LitImage {
 public:
  LitImage(const GreyImage& image, double gamma);
  /// The light between two fractional rows, blurred by a Gaussian of that standard deviation (pixels) both ways.
  [[nodiscard]] LitRow between(double top, double bottom, double sigma_px) const;
  /// Are all rows that light a stretch of that height, and that blur, the same? Then a number that tells which, the
  /// same for the same rows beside each other, else -1.
  [[nodiscard]] int uniform(double top, double bottom, double sigma_px) const;
  [[nodiscard]] double mean() const;

 private:
  [[nodiscard]] double light(int column, int row) const;
  const GreyImage& image_;
  double gamma_;
  std::vector<int> twin_;  // of each row: the first of the equal rows that end with it
};

}  // namespace vam::sim
