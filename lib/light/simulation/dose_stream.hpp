// SPDX-License-Identifier: GPL-3.0-or-later
// Simulation of a volume that does not fit into memory: rows of light in, doses out, block by block.
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "base/compute/slab.hpp"
#include "base/image.hpp"
#include "light/simulation/simulation.hpp"

namespace vam::light {

class Operator;

/// What Simulation::dose gives for all rows and slices at once, in a stream, to the byte: a block of slices is computed
/// as soon as all rows are there whose rays reach it. Memory: the light of these rows (columns that light the
/// resin x angles), 64 slices of dose, and with inserts their coverage and where they end the light of every row.
class DoseStream {
 public:
  /// `inserts`: coverage, one a slice of the grid, or none. Every slice goes to `out`, in ascending order. The
  /// simulation must outlive this, and its rows climb.
  DoseStream(const Simulation& simulation, std::span<const Image> inserts, std::function<void(Image)> out);
  ~DoseStream();

  /// The next rows of light, in ascending order. Throws Fault::data for images of another shape.
  void push(std::vector<Image> rows);
  /// After the last one.
  void finish();

 private:
  void take_slab();
  void emit_ready();
  void drop_rows_below(std::size_t row);
  void emit(std::size_t end);

  const Simulation& simulation_;
  std::function<void(Image)> out_;
  std::vector<Slab> bodies_;
  std::unique_ptr<Operator> around_;
  const Operator& light_;
  std::vector<Image> waiting_;  // fewer than a slab
  std::vector<Slab> rows_;      // from slab first_row_ on
  std::vector<Slab> doses_;
  std::size_t first_row_ = 0;
  std::size_t next_ = 0;  // slab of the grid
  bool finished_ = false;
};

}  // namespace vam::light
