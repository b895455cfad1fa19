// SPDX-License-Identifier: GPL-3.0-or-later
// What a camera beside the vial would see, for simulated cameras: the projector's image as fluorescence in the resin,
// and the print, which scatters; or an even card in the vial's place. Its rays are traced by vectors, which shares
// nothing with lib/optics.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "base/pixels.hpp"
#include "model/printer.hpp"
#include "sim/bench/body.hpp"
#include "sim/bench/photoresin.hpp"

namespace vam::sim {

class SimPrint;

/// The bench and its faults, as they truly are: what a calibration has to find.
struct SimBench {
  model::Printer printer;
  int columns = 720;  // of the whole sensor, pitch printer.camera.pixel_mm
  int rows = 540;
  double axis_column = 0;     // of the rotation axis in the image, from the middle of the sensor, sensor pixels
  double tilt_deg = 0;        // lean of the axis in the image, its lower end towards higher columns
  double centre_px = 0;       // of the vial in the projector's columns, from printer.projector.axis_column
  double wobble_mm = 0;       // the vial's axis goes round the stage's axis, at this distance
  double wobble_deg = 0;      // and stands towards +x of the lab at this stage angle
  double beam_mm = 0;         // full width at half maximum of the blur where the projector is in focus, a Gaussian
  double focus_mm = 0;        // where that is, along the light from the axis
  double divergence_deg = 0;  // growth of the full width per distance from there
  bool card = false;          // an even card stands in the vial's place: it shines by the image's mean
  double glow = 0.6;          // of full scale in 20 ms, for full light all through the vial
  double gamma = 1;           // intensity = (grey / full)^gamma
  double vignetting = 0;      // part of the light that the corners of the image lack
  double background = 0.02;   // of full scale
  double noise = 0;           // standard deviation, of full scale
  std::vector<SimBody> bodies{{1.5, 0, 0, 2.5, 0}, {-3.5, 1.0, 0, 1.2, 6.0}};
  double lit_s = 20;              // light that makes the print; its volume grows in proportion; 0: it is there
  std::optional<SimResin> resin;  // that light cures, instead of bodies that grow
  double lamp_drift_per_min = 0;  // relative change of its light, from the first on
  int specks = 0;                 // on window or lens, that stay where they are
  int seed = 1;
};

/// The state of the bench at a moment.
struct SimMoment {
  double angle_deg = 0;              // of the stage
  const GreyImage* image = nullptr;  // that the projector shows; none: black
  double lit_s = 0;                  // how long there was light so far
  double share = 1;                  // of the exposure
  const SimPrint* print = nullptr;   // that light has cured; none: bodies
};

/// Renders frames of one size.
class SimScene {
 public:
  /// binning sums nothing up: pixels are binning times as large and equally bright. bits 8 or 16.
  SimScene(const SimBench& bench, int binning, int bits);
  ~SimScene();
  [[nodiscard]] int columns() const;
  [[nodiscard]] int rows() const;
  /// number seeds the noise; exposure_us scales all light, 20 ms being 1.
  [[nodiscard]] GreyImage render(const SimMoment& moment, double exposure_us, long number) const;
  /// An exposure during which the bench changes: moments whose shares add up to 1.
  [[nodiscard]] GreyImage render(const std::vector<SimMoment>& exposure, double exposure_us, long number) const;

  struct State;

 private:
  std::unique_ptr<State> state_;
};

}  // namespace vam::sim
