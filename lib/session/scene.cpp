// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/scene.hpp"

#include <algorithm>
#include <cstdlib>

#include "base/compute/memory.hpp"
#include "base/error.hpp"
#include "base/log/log.hpp"
#include "base/text/text.hpp"
#include "io/settings/csv_table.hpp"
#include "io/stream/stream.hpp"
#include "light/grids/poses.hpp"
#include "light/operators/make_operator.hpp"
#include "model/dose/dose_metrics.hpp"
#include "model/dose/dose_spread.hpp"
#include "model/grid_size.hpp"
#include "optics/lit_fraction.hpp"
#include "optics/writable_radius.hpp"
#include "tomo/fbp.hpp"

namespace vam::session {

namespace {

model::Printer modelled(model::Printer printer, const JobOptions& options) {
  if (options.absorption_model == "none") printer.resin.absorption_per_mm = 0;
  return printer;
}

/// In the vial of that printer.
light::VialSetup light_of(const model::Printer& printer, const Scene& scene, const JobOptions& options) {
  light::VialSetup setup = light::vial_setup(modelled(printer, options), scene.grid, scene.turn.angles,
                                             scene.circle.radius * scene.grid.voxel_mm);
  if (scene.poses.empty()) return setup;
  setup.poses = scene.poses;
  setup.turn.rows = scene.frames();
  setup.rows = scene.rows;
  setup.first_row_mm = scene.first_row_mm;
  return setup;
}

/// A wobble that was measured and that the projections do not follow.
void warn_of_wobble(const model::Printer& printer, double voxel_mm) {
  const auto wobble_mm = io::wobble_in_force_mm(printer.calibration);
  if (!wobble_mm || *wobble_mm < 0.25 * voxel_mm) return;
  warn("the vial wobbles by " + format_number(*wobble_mm, 3) + " mm (" + format_number(*wobble_mm / voxel_mm, 2) +
       " voxels) according to " + printer.calibration.folder +
       "/current-edges.json; compensate for it by --wobble-record");
}

/// Of frames that are a few more or fewer than whole turns: by mistake, it seems.
void warn_of_rest(int frames, const JobOptions& options) {
  const int turns = std::max(round_int(static_cast<double>(frames) / options.angles), 1);
  const int rest = frames - turns * options.angles;
  if (rest == 0 || 20 * std::abs(rest) > options.angles) return;
  warn(options.poses + ": has " + std::to_string(frames) + " poses, " + std::to_string(std::abs(rest)) +
       (rest < 0 ? " fewer" : " more") + " than " + std::to_string(turns) + (turns == 1 ? " turn" : " turns") + " of " +
       std::to_string(options.angles) + " angles (--angles); the stage angles at the end are lit that much " +
       (rest < 0 ? "less" : "more"));
}

model::Poses poses_of(const model::Grid& part, const model::Printer& printer, const JobOptions& options) {
  if (options.helix_mm) return light::helix_poses(printer, part, *options.helix_mm, options.angles);
  if (!options.wobble_record.empty()) {
    const io::WobbleRecord wobble = io::read_wobble(options.wobble_record, printer, printer.stage.direction);
    return light::wobble_poses(wobble.radius_mm, wobble.lab_angle_deg, printer.stage.direction, options.angles);
  }
  if (options.poses.empty()) return {};
  model::Poses poses = io::read_poses(options.poses);
  io::require_angles(options.poses, poses, 0, 0, 360.0 / options.angles);
  warn_of_rest(count_of(poses), options);
  return poses;
}

/// The rows of light, and slices above the part where there are more rows than slices: both are as many.
void place_poses(Scene& scene, const model::Grid& part) {
  if (scene.poses.empty()) return;
  const light::Margin up_and_down{0, scene.margin.below, scene.margin.above};
  light::VialSetup setup = light::vial_setup(scene.printer, scene.grid, scene.turn.angles, 0);
  light::place_rows(setup, scene.poses, light::extended(part, up_and_down));
  scene.rows = setup.rows;
  scene.first_row_mm = setup.first_row_mm;
  scene.margin.above += std::max(0, scene.rows - scene.grid.nz);
}

/// auto: footprints where the light is absorbed or blocked, or has width.
light::LineIntegrals integrals_of(const light::ParallelBeam& beam, int slices, const JobOptions& options,
                                  bool inserts) {
  if (options.line_integrals == "fourier") return light::fourier_for(slices);
  const bool plain = !(beam.mu_per_px > 0 || beam.has_width() || inserts);
  if (options.line_integrals == "footprints" || !plain) return light::LineIntegrals::footprints;
  return light::quicker_for(slices, beam.turn);
}

light::Beam beam_of(const Scene& scene, const JobOptions& options, bool inserts) {
  if (options.in_vial()) return light_of(scene.printer, scene, options);
  const double voxel_mm = scene.grid.voxel_mm;
  const model::Printer printer = modelled(scene.printer, options);
  const double mu = printer.resin.absorption_per_mm * voxel_mm;
  light::ParallelBeam beam{scene.turn, mu, model::resin_radius_mm(printer.vial) / voxel_mm,
                           options.absorption_model == "disc" ? light::Correction::disc : light::Correction::exact};
  light::give_width(beam, printer);
  beam.integrals = integrals_of(beam, scene.grid.nz, options, inserts);
  return beam;
}

std::string reaches(const JobOptions& options, double farthest_mm) {
  return io::input_name(options.input) + ": reaches " + format_number(farthest_mm, 4) +
         " mm from the axis, beyond the ";
}

/// Parts beyond the writable radius.
void warn_of_reach(const io::SparseVolume& target, const model::Printer& printer, const JobOptions& options) {
  const double farthest = io::farthest_mm(target, model::coverage_rounding);
  const double writable = optics::writable_radius_mm(printer);
  if (optics::judged_radius_mm(printer, farthest) <= writable) return;
  warn(reaches(options, farthest) + "writable radius of " + format_number(writable, 4) +
       " mm; its outermost voxels are lit from " + format_number(100 * optics::lit_fraction(printer, farthest), 3) +
       " % of the stage angles, and doses there are accurate to 1 % of the maximum "
       "(RMS; single voxels to some per cent)");
}

/// Rows beyond the projector's stay dark.
void require_rows(const model::Grid& grid, const light::VialSetup& setup) {
  const double low_mm = grid.z_mm(0);
  const double high_mm = grid.z_mm(grid.nz - 1);
  if (high_mm >= setup.lowest_mm && low_mm <= setup.highest_mm) return;
  throw Error{Fault::data, "the slices span z = " + format_number(low_mm, 4) + " ... " + format_number(high_mm, 4) +
                               " mm, but the projector's rows cover " + format_number(setup.lowest_mm, 4) + " ... " +
                               format_number(setup.highest_mm, 4) + " mm; check projector.axis_row"};
}

/// The radius of the resin to constrain. Throws Fault::data where the part reaches beyond the resin.
double constrained_mm(const io::SparseVolume& target, const model::Printer& printer, const JobOptions& options) {
  if (!options.in_vial()) return optics::writable_radius_mm(printer);
  const double farthest = io::farthest_mm(target, model::coverage_rounding);
  const double edge = model::resin_radius_mm(printer.vial);
  if (farthest > edge) {
    throw Error{Fault::data, reaches(options, farthest) + "resin's edge at " + format_number(edge, 4) +
                                 " mm; scale the part down or use a wider vial"};
  }
  return optics::judged_radius_mm(printer, farthest);
}

}  // namespace

Scene make_scene(const io::SparseVolume& target, const model::Printer& printer, const JobOptions& options) {
  const model::Grid& grid = target.grid();
  const double radius_mm = constrained_mm(target, printer, options);
  const model::Poses poses = poses_of(grid, printer, options);
  light::require_in_reach(poses, printer, radius_mm);
  const light::Margin margin =
      options.in_vial()
          ? light::lit_margin(printer, grid, radius_mm, poses)
          : light::round_margin(grid, std::min(io::farthest_mm(target, model::coverage_rounding), radius_mm));
  const model::Grid lit = light::extended(grid, margin);
  Scene scene{lit, margin, printer, model::writable_circle(lit, radius_mm), {}, poses};
  const int columns = options.bins.value_or(tomo::columns_across(scene.circle, lit.nx));
  scene.turn = tomo::full_turn(lit, options.angles, columns);
  place_poses(scene, grid);
  scene.grid = light::extended(grid, scene.margin);
  if (options.in_vial() && poses.empty()) {
    require_rows(grid, std::get<light::VialSetup>(beam_of(scene, options, false)));
  } else if (!options.in_vial()) {
    scene.circle.radius = std::min(scene.circle.radius, 0.5 * columns);
  }
  return scene;
}

void warn_of(const Scene& scene, const io::SparseVolume& target, const JobOptions& options) {
  if (!options.in_vial()) return;
  warn_of_reach(target, scene.printer, options);
  if (scene.poses.empty()) warn_of_wobble(scene.printer, scene.grid.voxel_mm);
}

double diffusion_s(const Scene& scene, const JobOptions& options) {
  const model::PrinterStage& stage = scene.printer.stage;
  const bool once = !model::repeat(scene.poses);
  const double turns = once ? static_cast<double>(scene.frames()) / scene.turn.angles : stage.turns;
  return options.diffusion_time_s.value_or(model::seconds_of(stage, options.turns.value_or(turns)));
}

double blur_px(const model::Resin& resin, double seconds, const Scene& scene, const JobOptions& options) {
  return options.blur ? model::spread_mm(resin, seconds) / scene.grid.voxel_mm : 0;
}

std::unique_ptr<light::Operator> make_light(const Scene& scene, const JobOptions& options,
                                            std::span<const Slab> inserts) {
  constexpr double bytes_of_rays = 80;  // a voxel of a slice, at most
  require_memory(bytes_of_rays * static_cast<double>(scene.grid.slice_size()),
                 io::input_name(options.input) + ": " + model::size_text(scene.grid), "use larger voxels");
  return light::make_operator(beam_of(scene, options, !inserts.empty()), inserts);
}

optimize::TolerantPrinter tolerant(const Scene& scene, const JobOptions& options, const model::Tolerances& tolerances,
                                   double seconds) {
  return {scene.printer, tolerances, [&](const model::Printer& printer) { return light_of(printer, scene, options); },
          [&, seconds](const model::Resin& resin) { return blur_px(resin, seconds, scene, options); }};
}

}  // namespace vam::session
