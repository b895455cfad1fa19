#include "light/simulation.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <variant>

#include "base/constants.hpp"
#include "base/error.hpp"
#include "base/parallel.hpp"
#include "base/text.hpp"
#include "light/insert_shadow.hpp"
#include "light/shadowed_turn.hpp"
#include "light/trace.hpp"
#include "tomo/radon.hpp"

namespace vam::light {

namespace {

std::string mm(double value) { return format_number(value) + " mm"; }

// Back-projection with absorption, 16 slices a slab.
struct Parallel {
  tomo::ParallelGeometry geometry;
  std::vector<float> entry;          // per column: e^{-mu sqrt(R^2 - t^2)}, 0 beside the resin
  std::vector<unsigned char> resin;  // per voxel: is it there
  double step_rad = 0;
  model::Grid grid;
  double pixel_mm = 0;

  void dose(std::span<const Image> sinograms, std::span<Image> doses, std::span<const Image> inserts) const;
  void back_project(std::span<const Slab> in, std::span<Slab> out, std::span<const Image> inserts) const;
};

Parallel make_parallel(const model::Printer& printer, const model::StackInfo& info, const model::Grid& grid) {
  const double covered_deg = info.height * std::abs(info.angle_step_deg);
  if (!(std::abs(covered_deg - 360) < 0.01 * std::abs(info.angle_step_deg))) {
    throw Error{Fault::data, "sinogram: its " + std::to_string(info.height) + " angles cover " +
                                 format_number(covered_deg) + " deg; the dose needs exactly one turn"};
  }
  if (!(std::abs(grid.voxel_mm / info.pixel_mm - 1) < 1e-3)) {
    throw Error{Fault::data, "sinogram: its columns are " + mm(info.pixel_mm) + " wide, the voxels " +
                                 mm(grid.voxel_mm) + "; the parallel dose needs them alike"};
  }
  const double radius = model::resin_radius_mm(printer.vial);
  const double mu = printer.resin.absorption_per_mm;
  Parallel result;
  result.geometry = {grid.nx,
                     grid.ny,
                     info.width,
                     info.height,
                     -grid.origin_mm[0] / grid.voxel_mm,
                     -grid.origin_mm[1] / grid.voxel_mm,
                     info.angle_start_deg * rad_per_deg,
                     info.angle_step_deg * rad_per_deg,
                     -mu * grid.voxel_mm};
  result.step_rad = std::abs(info.angle_step_deg) * rad_per_deg;
  result.grid = grid;
  result.pixel_mm = info.pixel_mm;
  const optics::Detector detector = optics::centred_detector(info.width, info.pixel_mm);
  for (int c = 0; c < info.width; ++c) {
    const double square = radius * radius - detector.x_mm(c) * detector.x_mm(c);
    result.entry.push_back(square > 0 ? static_cast<float>(std::exp(-mu * std::sqrt(square))) : 0.0F);
  }
  for (int j = 0; j < grid.ny; ++j) {
    for (int i = 0; i < grid.nx; ++i) result.resin.push_back(std::hypot(grid.x_mm(i), grid.y_mm(j)) < radius ? 1 : 0);
  }
  return result;
}

void Parallel::back_project(std::span<const Slab> in, std::span<Slab> out, std::span<const Image> inserts) const {
  if (inserts.empty()) {
    tomo::adjoint(geometry, in, out);
    return;
  }
  ShadowedTurn turn(geometry, grid, pixel_mm);
  for (std::size_t g = 0; g < in.size(); ++g) {
    const std::size_t first = g * lanes;
    turn.back_project(in[g], inserts.subspan(first, std::min<std::size_t>(lanes, inserts.size() - first)), out[g]);
  }
}

void Parallel::dose(std::span<const Image> sinograms, std::span<Image> doses, std::span<const Image> inserts) const {
  const int groups = (static_cast<int>(sinograms.size()) + lanes - 1) / lanes;
  const auto slices_of = [&](int group) {
    return std::min<std::size_t>(lanes, sinograms.size() - static_cast<std::size_t>(group * lanes));
  };
  std::vector<Slab> in(static_cast<std::size_t>(groups), Slab(geometry.columns, geometry.angles));
  std::vector<Slab> out(static_cast<std::size_t>(groups), Slab(geometry.nx, geometry.ny));
  parallel_for(groups, [&](int g) {
    for (std::size_t s = 0; s < slices_of(g); ++s) {
      const Image& image = sinograms[static_cast<std::size_t>(g * lanes) + s];
      for (int a = 0; a < geometry.angles; ++a) {
        for (int c = 0; c < geometry.columns; ++c) {
          in[static_cast<std::size_t>(g)].at(c, a)[s] = image(c, a) * entry[static_cast<std::size_t>(c)];
        }
      }
    }
  });
  back_project(in, out, inserts);
  parallel_for(groups, [&](int g) {
    for (std::size_t s = 0; s < slices_of(g); ++s) {
      Image& image = doses[static_cast<std::size_t>(g * lanes) + s];
      image = Image(geometry.nx, geometry.ny);
      for (std::size_t p = 0; p < image.size(); ++p) {
        const float value = out[static_cast<std::size_t>(g)].values[p * lanes + s];
        image.values[p] = resin[p] != 0 ? static_cast<float>(step_rad) * value : 0.0F;
      }
    }
  });
  if (!inserts.empty()) light::darken(inserts, doses);
}

light::TraceSetup trace_setup(const model::Printer& printer, const optics::Alignment& alignment,
                              const model::StackInfo& info, const model::Grid& grid) {
  light::TraceSetup setup;
  setup.view = optics::projector_view(printer);
  setup.projector = optics::projector_detector(printer, alignment);
  if (info.width != setup.projector.columns || !(std::abs(info.pixel_mm / setup.projector.pixel_mm - 1) < 1e-3)) {
    throw Error{Fault::data, "sinogram: it has " + std::to_string(info.width) + " columns of " + mm(info.pixel_mm) +
                                 ", the projector " + std::to_string(setup.projector.columns) + " of " +
                                 mm(setup.projector.pixel_mm) + "; use the printer it was resampled for"};
  }
  setup.turn = optics::turn_of(info);
  setup.direction = alignment.reverse ? -printer.stage.direction : printer.stage.direction;
  setup.angle_offset_rad = alignment.angle_offset_rad;
  setup.absorption_per_mm = printer.resin.absorption_per_mm;
  setup.grid = grid;
  return setup;
}

}  // namespace

struct Simulation::State {
  std::variant<Parallel, light::Tracer> engine;
};

Simulation::Simulation(const model::Printer& printer, const optics::Alignment& alignment, const model::StackInfo& info,
                       const model::Grid& grid) {
  if (info.space == model::Space::projector) {
    state_ = std::make_unique<State>(State{light::Tracer(trace_setup(printer, alignment, info, grid))});
  } else if (info.space == model::Space::virtual_) {
    state_ = std::make_unique<State>(State{make_parallel(printer, info, grid)});
  } else {
    throw Error{Fault::data, "sinogram: a camera's leaves no dose; give a projector's or a virtual one"};
  }
}

Simulation::~Simulation() = default;

void Simulation::dose(std::span<const Image> sinograms, std::span<Image> doses, std::span<const Image> inserts) const {
  std::visit([&](const auto& engine) { engine.dose(sinograms, doses, inserts); }, state_->engine);
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

void shine(const Light& light, std::span<Image> sinograms, LightSeen& seen) {
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
