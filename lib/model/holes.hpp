// SPDX-License-Identifier: GPL-3.0-or-later
// Pieces of the solid of a field, and holes through them.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "model/euler.hpp"
#include "model/pieces.hpp"

namespace vam::model {

/// Of where a field, interpolated between the centres of voxels, reaches a level > 0; slice by slice. All slices go to
/// add() and, one by one, to add_pieces(), which other threads may do for other fields.
class FieldHoles {
 public:
  FieldHoles(int width, int height, double level, std::int64_t least_voxels)
      : pieces_(width, height, level, least_voxels), euler_(width, height, level) {}
  void add(int count, const float* slices) { euler_.add(count, slices); }
  void add_pieces(std::vector<float> slice) { pieces_.add(std::move(slice)); }
  /// Of least_voxels or more.
  [[nodiscard]] int pieces() const { return pieces_.count(); }
  /// Tunnels through all pieces, less the cavities in them.
  [[nodiscard]] std::int64_t holes() const { return pieces_.count_all() - euler_.characteristic(); }

 private:
  FieldPieces pieces_;
  EulerCounter euler_;
};

}  // namespace vam::model
