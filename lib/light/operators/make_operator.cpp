// SPDX-License-Identifier: GPL-3.0-or-later
#include "light/operators/make_operator.hpp"

#include <algorithm>
#include <cmath>

#include "base/compute/per_slice.hpp"
#include "base/constants.hpp"
#include "base/error.hpp"
#include "base/text/text.hpp"
#include "light/operators/private/attenuated_operator.hpp"
#include "light/operators/private/parallel_operator.hpp"
#include "light/operators/private/vial_operator.hpp"
#include "tomo/radon_choice.hpp"

namespace vam::light {

namespace {

tomo::ParallelGeometry parallel_turn(const model::StackInfo& info, const model::Grid& grid) {
  require_one_turn(info.height, info.angle_step_deg);
  if (!(std::abs(grid.voxel_mm / info.pixel_mm - 1) < 1e-3)) {
    throw Error{Fault::data, "sinogram: its columns are " + format_number(info.pixel_mm) + " mm wide, the voxels " +
                                 format_number(grid.voxel_mm) + " mm; a parallel-beam dose requires equal widths"};
  }
  return {grid.nx,
          grid.ny,
          info.width,
          info.height,
          -grid.origin_mm[0] / grid.voxel_mm,
          -grid.origin_mm[1] / grid.voxel_mm,
          info.angle_start_deg * rad_per_deg,
          info.angle_step_deg * rad_per_deg,
          0};
}

std::unique_ptr<Operator> operator_of(const VialSetup& setup, std::span<const Slab> inserts) {
  return std::make_unique<VialOperator>(setup, inserts);
}

/// The same beam, from a projector whose rays are parallel in a vial that refracts nothing, in voxels.
VialSetup vial_of(const ParallelBeam& beam) {
  const tomo::ParallelGeometry& turn = beam.turn;
  VialSetup setup;
  setup.view.shells = {{beam.resin_radius_px, 1}};
  setup.projector = optics::centred_detector(turn.columns, 1);
  setup.turn = {turn.angles, turn.angle_start_rad, turn.angle_step_rad};
  setup.absorption_per_mm = beam.mu_per_px;
  setup.hold_rad = beam.hold_rad;
  setup.half_angle_rad = beam.half_angle_rad;
  setup.grid = model::centred_grid(turn.nx, turn.ny, 1, 1);
  setup.grid.origin_mm[0] = -turn.axis_x;
  setup.grid.origin_mm[1] = -turn.axis_y;
  return setup;
}

std::unique_ptr<Operator> operator_of(const ParallelBeam& beam, std::span<const Slab> inserts) {
  const double mu = beam.mu_per_px;
  if (beam.integrals != LineIntegrals::footprints && (mu > 0 || !inserts.empty())) {
    throw Error{Fault::usage, "Fourier slices do not apply to light that is absorbed or blocked; use footprints"};
  }
  if (beam.has_width() && beam.integrals != LineIntegrals::footprints) {
    throw Error{Fault::usage,
                "Fourier slices do not apply to light that has width; use footprints, or stage.motion "
                "stepped without projector.half_angle_deg"};
  }
  if (!inserts.empty() && mu > 0 && beam.correction == Correction::disc) {
    throw Error{Fault::usage,
                "the disc normalisation of absorption does not apply around an insert; use the exact inverse"};
  }
  if (beam.has_width() || !inserts.empty()) return operator_of(vial_of(beam), inserts);
  if (mu == 0) return std::make_unique<ParallelOperator>(beam.turn, beam.integrals);
  return std::make_unique<AttenuatedOperator>(beam.turn, mu, beam.resin_radius_px, beam.correction);
}

}  // namespace

Beam beam_of(const model::Printer& printer, const optics::AxisAlignment& alignment, const model::StackInfo& info,
             const model::Grid& grid) {
  if (info.space == model::Space::projector) return vial_setup(printer, alignment, info, grid);
  if (info.space != model::Space::virtual_) {
    throw Error{Fault::data, "sinogram: a camera sinogram has no dose; a projector or virtual sinogram is required"};
  }
  ParallelBeam beam{parallel_turn(info, grid), printer.resin.absorption_per_mm * grid.voxel_mm,
                    model::resin_radius_mm(printer.vial) / grid.voxel_mm};
  give_width(beam, printer);
  return beam;
}

void give_width(ParallelBeam& beam, const model::Printer& printer) {
  beam.hold_rad = hold_rad(printer, beam.turn.angle_step_rad);
  beam.half_angle_rad = printer.projector.half_angle_deg.value_or(0) * rad_per_deg / printer.bath.index;
}

LineIntegrals fourier_for(int slices) { return slices == 1 ? LineIntegrals::fourier_of_one : LineIntegrals::fourier; }

LineIntegrals quicker_for(int slices, const tomo::ParallelGeometry& turn) {
  const std::size_t slabs = std::clamp((slices + lanes - 1) / lanes, 1, slabs_per_pass);
  const auto kind = slices == 1 ? tomo::FourierRadon::Slices::one : tomo::FourierRadon::Slices::all;
  const tomo::RadonCost cost = tomo::radon_cost(turn.with_alpha(0), slabs, kind);
  return cost.fourier < cost.footprints ? fourier_for(slices) : LineIntegrals::footprints;
}

std::unique_ptr<Operator> make_operator(const Beam& beam, std::span<const Slab> inserts) {
  return std::visit([&](const auto& light) { return operator_of(light, inserts); }, beam);
}

}  // namespace vam::light
