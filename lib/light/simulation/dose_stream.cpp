// SPDX-License-Identifier: GPL-3.0-or-later
#include "light/simulation/dose_stream.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

#include "base/compute/parallel.hpp"
#include "base/compute/per_slice.hpp"
#include "base/index.hpp"
#include "light/operators/insert.hpp"
#include "light/operators/operator.hpp"
#include "light/simulation/private/simulation_state.hpp"

namespace vam::light {

namespace {

std::size_t slabs_for(int slices) { return static_cast<std::size_t>((slices + lanes - 1) / lanes); }

std::vector<Slab> bodies_of(const Simulation::State& state, std::span<const Image> inserts) {
  return inserts.empty() ? std::vector<Slab>() : slabs_of(inserts, state.clear->object(), "insert");
}

}  // namespace

DoseStream::DoseStream(const Simulation& simulation, std::span<const Image> inserts, std::function<void(Image)> out)
    : simulation_(simulation),
      out_(std::move(out)),
      bodies_(bodies_of(simulation.state(), inserts)),
      around_(bodies_.empty() ? nullptr : simulation.state().around(bodies_)),
      light_(around_ ? *around_ : *simulation.state().clear) {}

DoseStream::~DoseStream() = default;

void DoseStream::push(std::vector<Image> rows) {
  for (Image& row : rows) {
    waiting_.push_back(std::move(row));
    if (waiting_.size() == lanes) take_slab();
  }
}

void DoseStream::finish() {
  if (!waiting_.empty()) take_slab();
  finished_ = true;
  emit_ready();
}

void DoseStream::take_slab() {
  rows_.push_back(std::move(collapsed(waiting_, light_).front()));
  waiting_.clear();
  emit_ready();
}

void DoseStream::emit_ready() {
  const std::size_t all = slabs_for(simulation_.state().grid.nz);
  while (next_ < all) {
    const std::size_t end = std::min(all, next_ + slabs_per_pass);
    const SlabRange needed = light_.lit_by({next_, end});
    if (needed.first < needed.end) {  // not a block that no row lights
      drop_rows_below(needed.first);
      if (!finished_ && needed.end > first_row_ + rows_.size()) return;
    }
    emit(end);
  }
}

/// The next blocks need none of them.
void DoseStream::drop_rows_below(std::size_t row) {
  const std::size_t passed = std::clamp(row, first_row_, first_row_ + rows_.size()) - first_row_;
  rows_.erase(rows_.begin(), rows_.begin() + static_cast<std::ptrdiff_t>(passed));
  first_row_ += passed;
}

void DoseStream::emit(std::size_t end) {
  const Simulation::State& state = simulation_.state();
  if (doses_.size() != end - next_) doses_ = slabs(end - next_, state.grid.nx, state.grid.ny);
  light_.adjoint_within({first_row_, rows_}, {next_, doses_});
  for (Slab& dose : doses_) {
    if (!bodies_.empty()) darken(bodies_[next_], dose);
    std::vector<Image> slices(std::min<std::size_t>(lanes, static_cast<std::size_t>(state.grid.nz) - next_ * lanes));
    parallel_for(count_of(slices), [&](int k) { slices[k] = state.in_resin(dose, k); });
    for (Image& slice : slices) out_(std::move(slice));
    ++next_;
  }
}

}  // namespace vam::light
