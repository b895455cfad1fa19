// SPDX-License-Identifier: GPL-3.0-or-later
// The dose of a stack of sinograms: by chief rays for a projector's stack, by parallel light for a virtual one.
#pragma once

#include <memory>
#include <span>

#include "base/image.hpp"
#include "light/rays/vial_setup.hpp"
#include "model/grid.hpp"
#include "model/printer.hpp"
#include "model/stack.hpp"
#include "optics/resample_stack.hpp"

namespace vam::light {

/// Whether rays that climb are followed, or each slice is lit by its own row alone.
enum class Climb { follow, flat };

/// The dose of one turn, in units of the sinogram times radian [physics §4, §11]: what the operator of that light makes
/// of the sinograms (A*, light/operators/operator.hpp); zero outside the resin. A projector's stack: chief rays, which
/// climb unless the projector is telecentric along the rows. A virtual stack: back-projection, light entering at the
/// resin's wall. Around an opaque insert (coverage nx x ny, one a slice, or none at all) light ends where its ray meets
/// it [CAL19 fig 4]; the insert receives no dose.
class Simulation {
 public:
  /// Throws Fault::data: angles that are not one turn, a camera stack, columns that are not the printer's, or voxels
  /// that differ from the virtual columns.
  Simulation(const model::Printer& printer, const optics::AxisAlignment& alignment, const model::StackInfo& info,
             const model::Grid& grid, Climb climb = Climb::follow);
  ~Simulation();
  /// Whether rows light other slices than their own. Then dose() takes all sinograms of the stack and gives all slices
  /// of the grid, as DoseStream does with less memory; otherwise any slices with their own sinograms.
  [[nodiscard]] bool climbs() const;
  /// Throws Fault::data for images of other sizes.
  void dose(std::span<const Image> sinograms, std::span<Image> doses, std::span<const Image> inserts = {}) const;

  struct State;  // private/simulation_state.hpp
  [[nodiscard]] const State& state() const { return *state_; }

 private:
  std::unique_ptr<State> state_;
};

}  // namespace vam::light
