// SPDX-License-Identifier: GPL-3.0-or-later
// Beam models, and the operator of each: parallel, attenuated, shadowed, or the refracted chief rays of the vial.
#pragma once

#include <memory>
#include <span>
#include <variant>

#include "light/operators/operator.hpp"
#include "light/rays/vial_setup.hpp"
#include "tomo/radon.hpp"

namespace vam::light {

/// How the first projections compensate for absorption: by the exact inverse of the exponential Radon transform [TM80],
/// or by dividing the target by the dose that a uniform disc receives [OST22 Methods], which is cheap and nearly as
/// good where little is absorbed. A and A* are exact in both cases.
enum class Correction { exact, disc };

/// How A and A* of clear parallel light are summed: by footprints, or to 1e-3 of the largest value by Fourier slices
/// [physics §1], which may be for passes of a single slice only. They are exact transposes in all cases.
enum class LineIntegrals { footprints, fourier, fourier_of_one };

/// Parallel light that enters at the resin's wall.
struct ParallelBeam {
  tomo::ParallelGeometry turn;  // 360 degrees, its end excluded
  double mu_per_px = 0;         // absorption
  double resin_radius_px = 0;
  Correction correction = Correction::exact;
  LineIntegrals integrals = LineIntegrals::footprints;
  double hold_rad = 0;        // the stage turns by it while a frame is shown
  double half_angle_rad = 0;  // of bundles whose focus is on the axis; seen along the rotation axis only

  [[nodiscard]] bool has_width() const { return hold_rad > 0 || half_angle_rad > 0; }
};

/// As the turning stage and the lens spread it: what aims at the axis of a round vial keeps its angle, behind a flat
/// window it is refracted.
void give_width(ParallelBeam& beam, const model::Printer& printer);

/// A virtual projector's light, or the chief rays of a real one.
using Beam = std::variant<ParallelBeam, VialSetup>;

/// The light that a stack of sinograms holds, for the doses of that grid. Throws Fault::data: a camera stack, angles
/// that are not one turn, columns that are not the printer's, or voxels that differ from the virtual columns.
[[nodiscard]] Beam beam_of(const model::Printer& printer, const optics::AxisAlignment& alignment,
                           const model::StackInfo& info, const model::Grid& grid);

/// Fourier slices for passes of a part with so many slices.
[[nodiscard]] LineIntegrals fourier_for(int slices);
/// The quicker way, by a model of what both cost.
[[nodiscard]] LineIntegrals quicker_for(int slices, const tomo::ParallelGeometry& turn);

/// A and A* of that light, around opaque inserts if there are any: a slab of coverage for every slab of the pass.
/// Throws Fault::usage for the disc correction around inserts, and for Fourier slices around them or in an absorber,
/// Fault::data where light does not get through.
[[nodiscard]] std::unique_ptr<Operator> make_operator(const Beam& beam, std::span<const Slab> inserts = {});

}  // namespace vam::light
