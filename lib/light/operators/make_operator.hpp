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

/// Parallel light that enters at the resin's wall.
struct ParallelBeam {
  tomo::ParallelGeometry turn;  // 360 degrees, its end excluded
  double mu_per_px = 0;         // absorption
  double resin_radius_px = 0;
  Correction correction = Correction::exact;
};

/// A virtual projector's light, or the chief rays of a real one.
using Beam = std::variant<ParallelBeam, VialSetup>;

/// The light that a stack of sinograms holds, for the doses of that grid. Throws Fault::data: a camera stack, angles
/// that are not one turn, columns that are not the printer's, or voxels that differ from the virtual columns.
[[nodiscard]] Beam beam_of(const model::Printer& printer, const optics::AxisAlignment& alignment,
                           const model::StackInfo& info, const model::Grid& grid);

/// A and A* of that light, around opaque inserts if there are any: a slab of coverage for every slab of the pass.
/// Throws Fault::usage for the disc correction around inserts, Fault::data where light does not get through.
[[nodiscard]] std::unique_ptr<Operator> make_operator(const Beam& beam, std::span<const Slab> inserts = {});

}  // namespace vam::light
