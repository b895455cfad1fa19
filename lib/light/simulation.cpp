#include "light/simulation.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>

#include "base/constants.hpp"
#include "base/error.hpp"
#include "base/parallel.hpp"
#include "base/per_slice.hpp"
#include "base/text.hpp"
#include "light/attenuated.hpp"
#include "light/parallel.hpp"
#include "light/shadowed.hpp"
#include "light/vial.hpp"

namespace vam::light {

namespace {

std::string mm(double value) { return format_number(value) + " mm"; }

void require_one_turn(const model::StackInfo& info) {
  const double covered_deg = info.height * std::abs(info.angle_step_deg);
  if (std::abs(covered_deg - 360) < 0.01 * std::abs(info.angle_step_deg)) return;
  throw Error{Fault::data, "sinogram: its " + std::to_string(info.height) + " angles cover " +
                               format_number(covered_deg) + " deg; the dose needs exactly one turn"};
}

tomo::ParallelGeometry parallel_turn(const model::StackInfo& info, const model::Grid& grid) {
  require_one_turn(info);
  if (!(std::abs(grid.voxel_mm / info.pixel_mm - 1) < 1e-3)) {
    throw Error{Fault::data, "sinogram: its columns are " + mm(info.pixel_mm) + " wide, the voxels " +
                                 mm(grid.voxel_mm) + "; the parallel dose needs them alike"};
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

VialSetup projector_turn(const model::Printer& printer, const optics::AxisAlignment& alignment,
                         const model::StackInfo& info, const model::Grid& grid) {
  VialSetup setup;
  setup.view = optics::projector_view(printer);
  setup.projector = optics::projector_detector(printer, alignment);
  if (info.width != setup.projector.columns || !(std::abs(info.pixel_mm / setup.projector.pixel_mm - 1) < 1e-3)) {
    throw Error{Fault::data, "sinogram: it has " + std::to_string(info.width) + " columns of " + mm(info.pixel_mm) +
                                 ", the projector " + std::to_string(setup.projector.columns) + " of " +
                                 mm(setup.projector.pixel_mm) + "; use the printer it was resampled for"};
  }
  if (info.row_mm > 0 && !(std::abs(info.row_mm / grid.voxel_mm - 1) < 1e-3)) {
    throw Error{Fault::data, "sinogram: its slices are " + mm(info.row_mm) + " apart, the voxels " + mm(grid.voxel_mm) +
                                 ": they are not slices of the volume; make both from the same target"};
  }
  setup.turn = optics::turn_of(info);
  setup.direction = alignment.reverse ? -printer.stage.direction : printer.stage.direction;
  setup.angle_offset_rad = alignment.angle_offset_rad;
  setup.absorption_per_mm = printer.resin.absorption_per_mm;
  setup.grid = grid;
  setup.z_scale = model::vertical_magnification(printer);
  setup.rows = info.count;
  setup.first_row_mm = info.z_start_mm;
  return setup;
}

void require_shape(std::span<const Image> images, Shape shape, const std::string& what) {
  for (const Image& image : images) {
    if (image.width == shape.width && image.height == shape.height) continue;
    throw Error{Fault::data, what + ": a slice has " + std::to_string(image.width) + " x " +
                                 std::to_string(image.height) + " pixels, but " + std::to_string(shape.width) + " x " +
                                 std::to_string(shape.height) + " are needed"};
  }
}

std::vector<Slab> slabs_of(std::span<const Image> images, Shape shape, const std::string& what) {
  require_shape(images, shape, what);
  return packed(images, shape.width, shape.height);
}

}  // namespace

/// How to make the light, and the light itself where no insert stands in its way.
struct Simulation::State {
  model::Grid grid;
  double resin_mm = 0;
  std::function<std::unique_ptr<Operator>(std::span<const Slab> inserts)> make;
  std::unique_ptr<Operator> clear;

  /// Outside the resin there is nothing that takes a dose.
  [[nodiscard]] bool resin_at(int i, int j) const { return std::hypot(grid.x_mm(i), grid.y_mm(j)) < resin_mm; }
};

Simulation::Simulation(const model::Printer& printer, const optics::AxisAlignment& alignment,
                       const model::StackInfo& info, const model::Grid& grid, Climb climb)
    : state_(std::make_unique<State>()) {
  state_->grid = grid;
  state_->resin_mm = model::resin_radius_mm(printer.vial);
  if (info.space == model::Space::projector) {
    VialSetup setup = projector_turn(printer, alignment, info, grid);
    if (climb == Climb::flat) setup.view.rows_lens_mm.reset();
    state_->make = [setup](std::span<const Slab> inserts) { return std::make_unique<VialOperator>(setup, inserts); };
  } else if (info.space == model::Space::virtual_) {
    const auto turn = parallel_turn(info, grid);
    const double mu = printer.resin.absorption_per_mm * grid.voxel_mm;
    const double radius = state_->resin_mm / grid.voxel_mm;
    state_->make = [turn, mu, radius](std::span<const Slab> inserts) -> std::unique_ptr<Operator> {
      if (!inserts.empty()) return std::make_unique<ShadowedOperator>(turn, mu, radius, inserts);
      if (mu > 0) return std::make_unique<AttenuatedOperator>(turn, mu, radius);
      return std::make_unique<ParallelOperator>(turn);
    };
  } else {
    throw Error{Fault::data, "sinogram: a camera sinogram has no dose; a projector or virtual sinogram is required"};
  }
  state_->clear = state_->make({});
}

Simulation::~Simulation() = default;

bool Simulation::climbs() const { return state_->clear->couples_slices(); }

void Simulation::dose(std::span<const Image> sinograms, std::span<Image> doses, std::span<const Image> inserts) const {
  const State& state = *state_;
  std::vector<Slab> bodies;
  std::unique_ptr<Operator> around;
  if (!inserts.empty()) {
    bodies = slabs_of(inserts, state.clear->object(), "insert");
    around = state.make(bodies);
  }
  const Operator& light = around ? *around : *state.clear;
  std::vector<Slab> rows =
      slabs((sinograms.size() + lanes - 1) / lanes, light.sinogram().width, light.sinogram().height);
  for (std::size_t s = 0; s < rows.size(); ++s) {
    const auto slices = sinograms.subspan(s * lanes, std::min<std::size_t>(lanes, sinograms.size() - s * lanes));
    light.collapse(slabs_of(slices, light.image(), "sinogram").front(), rows[s]);
  }
  std::vector<Slab> out = slabs((doses.size() + lanes - 1) / lanes, state.grid.nx, state.grid.ny);
  light.adjoint(rows, out);
  for (std::size_t s = 0; s < bodies.size(); ++s) darken(bodies[s], out[s]);
  parallel_for(static_cast<int>(doses.size()), [&](int k) {
    const auto slice = static_cast<std::size_t>(k);
    const Slab& slab = out[slice / lanes];
    Image& image = doses[slice];
    image = Image(state.grid.nx, state.grid.ny);
    for (int j = 0; j < state.grid.ny; ++j) {
      for (int i = 0; i < state.grid.nx; ++i) {
        if (state.resin_at(i, j)) image(i, j) = slab.at(i, j)[slice % lanes];
      }
    }
  });
}

model::Grid dose_grid(const model::Printer& printer, const model::StackInfo& info, std::optional<double> size_mm) {
  const bool parallel = info.space == model::Space::virtual_;
  const double voxel_mm = info.row_mm > 0 ? info.row_mm : info.pixel_mm;
  if (parallel && !(std::abs(voxel_mm / info.pixel_mm - 1) < 1e-3)) {
    throw Error{Fault::data, "sinogram: its slices are " + mm(voxel_mm) + " apart, its columns " + mm(info.pixel_mm) +
                                 "; voxels are cubes"};
  }
  const double all = parallel ? info.width * info.pixel_mm : 2 * optics::reach_mm(optics::projector_view(printer));
  const int n = std::max(1, static_cast<int>(std::ceil(size_mm.value_or(all) / voxel_mm - 1e-6)));
  return model::centred_grid(n, n, info.count, voxel_mm, info.z_start_mm);
}

int first_slice(const model::Grid& grid, const model::StackInfo& info) {
  const double pitch_mm = info.row_mm > 0 ? info.row_mm : grid.voxel_mm;
  const double place = (info.z_start_mm - grid.origin_mm[2]) / grid.voxel_mm;
  const double drift = info.count * std::abs(pitch_mm / grid.voxel_mm - 1);
  const int first = static_cast<int>(std::lround(place));
  // A hundredth of a voxel: rounding, not another grid.
  if (drift > 0.01 || std::abs(place - first) > 0.01 || first < 0 || first + info.count > grid.nz) {
    throw Error{Fault::data, "sinogram: " + std::to_string(info.count) + " slices of " + mm(pitch_mm) + " from z = " +
                                 mm(info.z_start_mm) + " are not slices of the volume, " + std::to_string(grid.nz) +
                                 " of " + mm(grid.voxel_mm) + " from z = " + mm(grid.origin_mm[2])};
  }
  return first;
}

void shine(const DisplayRange& light, std::span<Image> sinograms, LightSeen& seen) {
  const float scale = light.full_scale ? static_cast<float>(1 / *light.full_scale) : 1.0F;
  const float least = light.full_scale ? static_cast<float>(light.dark) : 0.0F;
  for (Image& image : sinograms) {
    for (float& value : image.values) {
      seen.peak = std::max(seen.peak, static_cast<double>(value));
      seen.least = std::min(seen.least, static_cast<double>(value));
      seen.negative += value < 0 ? 1 : 0;
      value *= scale;
      if (light.clip) value = std::max(value, least);
      if (light.full_scale) value = std::min(value, 1.0F);
    }
    seen.values += static_cast<double>(image.size());
    seen.efficiency.add(image.values);
  }
}

}  // namespace vam::light
