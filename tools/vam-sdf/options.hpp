// SPDX-License-Identifier: GPL-3.0-or-later
// Options of vam-sdf.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cli/app.hpp"

namespace vam::sdf_tool {

struct Options {
  std::string print = "-";
  std::string design;
  std::string output;
  std::string align = "full";
  bool scale = false;
  std::optional<double> isovalue;
  std::string resin_record;
  std::optional<double> pieces_mm3;
  double design_isovalue = 0.5;
  int samples = 200000;
  std::string histogram;
  int bins = 101;
  std::optional<double> limit_mm;
  std::string require;
  std::string report;
  std::vector<std::string> tolerances;
  std::vector<std::string> regions;
  std::vector<std::string> datum;
  std::string uncertainty;
  double isovalue_uncertainty = 0;
  double scale_uncertainty_percent = 0;
  bool guard_band = false;
  std::string volume;
  double volume_voxel_mm = 0;
};

/// vam-sdf height.
struct HeightOptions {
  std::string image = "-";
  std::string design;
  double pixel_mm = 0.05;
  double full_mm = 1;
  std::optional<double> lowest_mm;
  std::string align = "full";
  double design_isovalue = 0.5;
  std::string output;
  std::vector<double> line;
  std::string plot;
  std::string require;
  std::string report;
};

/// vam-sdf trend.
struct TrendOptions {
  std::vector<std::string> runs;
  std::string figure = "print_to_design.rms_mm";
  std::string plot;
  std::string report;
};

/// Print against design.
void deviation(const cli::App& app, const Options& options);

/// Height image against design.
void height(const HeightOptions& options);

/// Figures over repeated prints.
void trend(const TrendOptions& options);

}  // namespace vam::sdf_tool
