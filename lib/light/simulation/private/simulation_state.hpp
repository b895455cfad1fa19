// SPDX-License-Identifier: GPL-3.0-or-later
// State of the simulation: its beam model, whole or block by block.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "base/compute/slab.hpp"
#include "base/image.hpp"
#include "light/operators/make_operator.hpp"
#include "light/operators/operator.hpp"
#include "light/simulation/simulation.hpp"

namespace vam::light {

/// The light, and its operator where no insert stands in its way.
struct Simulation::State {
  model::Grid grid;
  double resin_mm = 0;
  Beam beam;
  std::unique_ptr<Operator> clear;

  /// The operator around inserts, a slab of coverage for every slab of the pass.
  [[nodiscard]] std::unique_ptr<Operator> around(std::span<const Slab> bodies) const {
    return make_operator(beam, bodies);
  }
  /// One slice of a slab; outside the resin there is nothing that takes a dose.
  [[nodiscard]] Image in_resin(const Slab& slab, std::size_t lane) const;
};

/// Slices side by side. Throws Fault::data for images of another shape; `what` names them.
[[nodiscard]] std::vector<Slab> slabs_of(std::span<const Image> images, Shape shape, const std::string& what);

/// The operator's unknowns for the light that is shown.
[[nodiscard]] std::vector<Slab> collapsed(std::span<const Image> sinograms, const Operator& light);

}  // namespace vam::light
