// SPDX-License-Identifier: GPL-3.0-or-later
// A simulated print: what projected light truly makes of the resin in the turning vial.
#pragma once

#include <memory>

#include "base/pixels.hpp"
#include "sim/bench/photoresin.hpp"
#include "sim/bench/scene.hpp"

namespace vam::sim {

/// The resin in sight of the camera and in reach of the projector, on voxels in the frame of the part. The bench's
/// printer is the true one: a tool that is given another one is wrong about it.
class SimPrint {
 public:
  /// Throws Fault::usage where bench.resin is missing, or its printer has no absorption or critical dose.
  explicit SimPrint(const SimBench& bench);
  ~SimPrint();
  SimPrint(const SimPrint&) = delete;
  SimPrint& operator=(const SimPrint&) = delete;

  /// Time passes, with that image on (none: dark) and the stage at that angle.
  void pass(const GreyImage* image, double angle_deg, double seconds);
  [[nodiscard]] const Photoresin& resin() const;
  /// How long there was light.
  [[nodiscard]] double lit_s() const;
  /// Angle of the part in the frame of lenses, radians.
  [[nodiscard]] double part_rad(double angle_deg) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// One turn: frames follow each other from stage angle 0 at the speed of bench.printer.stage, each for an equal part of
/// the turn; between them, `views` images of the camera at equal steps, their numbers from `first`.
struct SimView {
  double angle_deg = 0;  // at the middle of the exposure
  GreyImage levels;
};
[[nodiscard]] std::vector<SimView> play_turn(const SimBench& bench, const SimScene& scene, SimPrint& print,
                                             const std::vector<GreyImage>& frames, int views, long first);

}  // namespace vam::sim
