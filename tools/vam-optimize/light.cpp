#include "vam-optimize/light.hpp"

#include <algorithm>

#include "base/error.hpp"
#include "base/text.hpp"
#include "light/attenuated.hpp"
#include "light/blur.hpp"
#include "light/parallel.hpp"
#include "light/shadowed.hpp"
#include "light/vial.hpp"
#include "optics/writable.hpp"
#include "optimize/run/volume.hpp"
#include "tomo/fbp.hpp"

namespace vam::optimize_tool {

namespace {

double mu_per_px(const Scene& scene, const Options& options) {
  return options.absorption_model == "none" ? 0 : scene.printer.resin.absorption_per_mm * scene.grid.voxel_mm;
}

double radius_px(const Scene& scene) { return model::resin_radius_mm(scene.printer.vial) / scene.grid.voxel_mm; }

light::VialSetup vial_setup(const Scene& scene, const Options& options) {
  const double radius_mm = scene.circle.radius * scene.grid.voxel_mm;
  light::VialSetup setup = light::vial_setup(scene.printer, scene.grid, scene.turn.angles, radius_mm);
  if (options.absorption_model == "none") setup.absorption_per_mm = 0;
  return setup;
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

}  // namespace

Scene make_scene(const model::Grid& grid, const model::Printer& printer, const Options& options) {
  const light::Margin margin = options.geometry == "vial" ? light::lit_margin(printer, grid) : light::Margin{};
  const model::Grid lit = light::extended(grid, margin);
  Scene scene{lit, margin, printer, model::writable_circle(lit, optics::writable_radius_mm(printer)), {}};
  const int columns = options.columns.value_or(optimize::columns_for(scene.circle, lit.nx));
  scene.turn = tomo::full_turn(lit, options.angles, columns);
  if (options.geometry == "vial") {
    require_rows(grid, vial_setup(scene, options));
  } else {
    scene.circle.radius = std::min(scene.circle.radius, 0.5 * columns);
  }
  return scene;
}

double blur_px(const Scene& scene, const Options& options) {
  if (options.no_blur) return 0;
  const model::PrinterStage& stage = scene.printer.stage;
  const double seconds = options.seconds.value_or(model::seconds_of(stage, options.turns.value_or(stage.turns)));
  const model::Resin& resin = scene.printer.resin;
  return light::spread_mm(resin.psf_mm, resin.diffusion_mm2_s, seconds) / scene.grid.voxel_mm;
}

std::unique_ptr<light::Operator> make_light(const Scene& scene, const Options& options) {
  if (options.geometry == "vial") return std::make_unique<light::VialOperator>(vial_setup(scene, options));
  const double mu = mu_per_px(scene, options);
  if (mu == 0) return std::make_unique<light::ParallelOperator>(scene.turn);
  const auto correction = options.absorption_model == "disc" ? light::Correction::disc : light::Correction::exact;
  return std::make_unique<light::AttenuatedOperator>(scene.turn, mu, radius_px(scene), correction);
}

std::unique_ptr<light::Operator> make_light(const Scene& scene, const Options& options, std::span<const Slab> inserts) {
  if (options.geometry == "vial") return std::make_unique<light::VialOperator>(vial_setup(scene, options), inserts);
  if (options.absorption_model == "disc" && mu_per_px(scene, options) > 0) {
    throw Error{Fault::usage, "--absorption-model disc: does not apply around an insert; use exact"};
  }
  return std::make_unique<light::ShadowedOperator>(scene.turn, mu_per_px(scene, options), radius_px(scene), inserts);
}

}  // namespace vam::optimize_tool
