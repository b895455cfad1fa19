// SPDX-License-Identifier: GPL-3.0-or-later
// The resin of a simulated print: absorbed light is first spent on the inhibitor, then grows conversion, and conversion
// scatters [physics §15]. It shares no model with the tools that plan a print.
#pragma once

#include <vector>

#include "model/grid.hpp"

namespace vam::sim {

struct SimResin {
  double voxel_mm = 0.2;
  double critical_dose_mj_cm3 = 0;          // with which resin of the mean inhibitor just gels, in the end
  double induction = 0.5;                   // share of it that the inhibitor takes
  double delay_s = 3;                       // lifetime of radicals: conversion follows the light by it
  double inhibition_gradient = 0;           // relative change of the inhibitor from the lowest to the highest slice
  double inhibitor_diffusion_mm2_s = 1e-4;  // of the inhibitor
  double dose_diffusion_mm2_s = 0;          // of the radicals
  double gel_conversion = 0.3;
  double scatter_width = 0.03;  // of the rise of scattering about it, in conversion
};

/// What has become of the resin, voxel by voxel.
class Photoresin {
 public:
  Photoresin(const SimResin& about, const model::Grid& grid);

  /// Energy that voxels absorb from now on, mJ/cm3 each: light is added here.
  [[nodiscard]] std::vector<float>& absorbed() { return absorbed_; }
  /// Lets `seconds` pass, in which what was absorbed came in evenly.
  void react(double seconds);

  /// Conversion over that of the gel point: solid from 1 on.
  [[nodiscard]] model::Volume conversion() const;
  /// Scattering density, 0 of the liquid to 1.
  [[nodiscard]] const model::Volume& scatter() const { return scatter_; }
  /// Voxels, from the first to one behind the last along each axis, beyond which nothing scatters.
  struct Box {
    int low[3];
    int high[3];
  };
  [[nodiscard]] const Box& scattering() const { return scattering_; }

 private:
  void react_slice(int k, double seconds);
  void diffuse(std::vector<float>& field, double spread);
  [[nodiscard]] double scatter_of(double conversion) const;
  void widen(std::size_t voxel);

  SimResin about_;
  model::Grid grid_;
  double inhibition_mj_cm3_;  // dose that the mean inhibitor takes
  double growth_mj_cm3_;      // further dose that converts 1 - 1/e of what is left
  std::vector<float> absorbed_, inhibitor_, radicals_, conversion_, scratch_;
  model::Volume scatter_;
  std::vector<char> lit_;  // slices in which there was light
  Box scattering_;
};

}  // namespace vam::sim
