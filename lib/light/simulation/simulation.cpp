// SPDX-License-Identifier: GPL-3.0-or-later
#include "light/simulation/simulation.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "base/compute/parallel.hpp"
#include "base/compute/per_slice.hpp"
#include "base/error.hpp"
#include "base/index.hpp"
#include "light/operators/insert.hpp"
#include "light/simulation/private/simulation_state.hpp"

namespace vam::light {

namespace {

void require_shape(std::span<const Image> images, Shape shape, const std::string& what) {
  for (const Image& image : images) {
    if (image.width == shape.width && image.height == shape.height) continue;
    throw Error{Fault::data, what + ": a slice has " + std::to_string(image.width) + " x " +
                                 std::to_string(image.height) + " pixels, but " + std::to_string(shape.width) + " x " +
                                 std::to_string(shape.height) + " are needed"};
  }
}

}  // namespace

std::vector<Slab> slabs_of(std::span<const Image> images, Shape shape, const std::string& what) {
  require_shape(images, shape, what);
  return packed(images, shape.width, shape.height);
}

std::vector<Slab> collapsed(std::span<const Image> sinograms, const Operator& light) {
  const Shape shape = light.sinogram();
  std::vector<Slab> rows = slabs((sinograms.size() + lanes - 1) / lanes, shape.width, shape.height);
  for (std::size_t s = 0; s < rows.size(); ++s) {
    const auto slices = sinograms.subspan(s * lanes, std::min<std::size_t>(lanes, sinograms.size() - s * lanes));
    light.collapse(slabs_of(slices, light.image(), "sinogram").front(), rows[s]);
  }
  return rows;
}

Image Simulation::State::in_resin(const Slab& slab, std::size_t lane) const {
  Image image(grid.nx, grid.ny);
  for (int j = 0; j < grid.ny; ++j) {
    for (int i = 0; i < grid.nx; ++i) {
      if (std::hypot(grid.x_mm(i), grid.y_mm(j)) < resin_mm) image(i, j) = slab.at(i, j)[lane];
    }
  }
  return image;
}

Simulation::Simulation(const model::Printer& printer, const optics::AxisAlignment& alignment,
                       const model::StackInfo& info, const model::Grid& grid, Climb climb)
    : state_(std::make_unique<State>()) {
  state_->grid = grid;
  state_->resin_mm = model::resin_radius_mm(printer.vial);
  state_->beam = beam_of(printer, alignment, info, grid);
  auto* vial = std::get_if<VialSetup>(&state_->beam);
  if (vial != nullptr && climb == Climb::flat) {
    vial->view.rows_lens_mm.reset();
    vial->rows_half_angle_rad = 0;
  }
  state_->clear = make_operator(state_->beam);
}

Simulation::~Simulation() = default;

bool Simulation::climbs() const { return state_->clear->couples_slices(); }

void Simulation::dose(std::span<const Image> sinograms, std::span<Image> doses, std::span<const Image> inserts) const {
  const State& state = *state_;
  std::vector<Slab> bodies;
  std::unique_ptr<Operator> around;
  if (!inserts.empty()) {
    bodies = slabs_of(inserts, state.clear->object(), "insert");
    around = state.around(bodies);
  }
  const Operator& light = around ? *around : *state.clear;
  const std::vector<Slab> rows = collapsed(sinograms, light);
  std::vector<Slab> out = slabs((doses.size() + lanes - 1) / lanes, state.grid.nx, state.grid.ny);
  light.adjoint(rows, out);
  for (std::size_t s = 0; s < bodies.size(); ++s) darken(bodies[s], out[s]);
  parallel_for(count_of(doses), [&](int k) { doses[k] = state.in_resin(out[k / lanes], k % lanes); });
}

}  // namespace vam::light
