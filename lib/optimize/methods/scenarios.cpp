// SPDX-License-Identifier: GPL-3.0-or-later
#include "optimize/methods/scenarios.hpp"

#include <algorithm>
#include <cstdint>
#include <numeric>

#include "base/compute/per_slice.hpp"
#include "base/random.hpp"
#include "light/operators/blurred_operator.hpp"
#include "model/magnification.hpp"

namespace vam::optimize {

namespace {

/// The same frames as unknowns of another operator: columns that it lacks stay dark. Its transpose is the same with
/// `from` and `to` exchanged.
std::vector<Slab> carried(std::span<const Slab> sinograms, const light::Operator& from, const light::Operator& to) {
  std::vector<Slab> there = slabs(sinograms.size(), to.sinogram().width, to.sinogram().height);
  Slab frames(from.image().width, from.image().height);
  for (std::size_t s = 0; s < there.size(); ++s) {
    from.expand(sinograms[s], frames);
    to.collapse(frames, there[s]);
  }
  return there;
}

void dim(std::span<Slab> images, double intensity) {
  const auto factor = static_cast<float>(intensity);
  for_values(images, [&](std::size_t s, std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) images[s].values[i] *= factor;
  });
}

}  // namespace

Scenario scenario_of(const TolerantPrinter& printer, const model::PrinterDeviation& by, std::span<const Slab> inserts) {
  const model::DeviatingPrinter off = model::deviate(printer.printer, printer.tolerances, by);
  light::VialSetup setup = printer.setup(off.printer);
  setup.angle_offset_rad += off.angle_offset_rad;
  setup.z_scale = model::vertical_magnification(printer.printer);
  light::displace(setup, off.vial_x_mm, off.vial_y_mm, off.sinking_mm);
  return {light::make_operator(setup, inserts), printer.blur_px(off.printer.resin), off.intensity, off.rim};
}

std::vector<Scenario> corner_scenarios(const TolerantPrinter& printer, std::span<const Slab> inserts) {
  std::vector<Scenario> all;
  for (const model::PrinterDeviation& corner : model::balanced_corners())
    all.push_back(scenario_of(printer, corner, inserts));
  return all;
}

Scenarios::Scenarios(const light::Operator& nominal, std::vector<Scenario> bank, int slices) : nominal_(nominal) {
  for (Scenario& one : bank) {
    Member& member = bank_.emplace_back(Member{std::move(one), nullptr});
    if (member.scenario.blur_px <= 0) continue;
    member.blurred = std::make_unique<light::BlurredOperator>(*member.scenario.light, member.scenario.blur_px, slices);
  }
}

void Scenarios::adjoint(int scenario, std::span<const Slab> sinograms, std::span<Slab> objects) const {
  const Member& member = bank_[scenario];
  member.light().adjoint(carried(sinograms, nominal_, member.light()), objects);
  dim(objects, member.scenario.intensity);
}

void Scenarios::forward(int scenario, std::span<const Slab> objects, std::span<Slab> sinograms) const {
  const Member& member = bank_[scenario];
  const light::Shape shape = member.light().sinogram();
  std::vector<Slab> own = slabs(objects.size(), shape.width, shape.height);
  member.light().forward(objects, own);
  dim(own, member.scenario.intensity);
  std::vector<Slab> there = carried(own, member.light(), nominal_);
  std::move(there.begin(), there.end(), sinograms.begin());
}

std::pair<int, int> Scenarios::drawn(int iteration) const {
  const int pairs = count() / 2;
  std::vector<int> order(pairs);
  std::iota(order.begin(), order.end(), 0);
  const auto round = static_cast<std::uint64_t>(iteration / pairs);
  std::uint64_t state = scrambled(round);
  for (int left = pairs; left > 1; --left) {
    state = scrambled(state);
    std::swap(order[left - 1], order[state % static_cast<std::uint64_t>(left)]);
  }
  const int pair = order[iteration % pairs];
  return {2 * pair, 2 * pair + 1};
}

}  // namespace vam::optimize
