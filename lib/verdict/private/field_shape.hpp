// SPDX-License-Identifier: GPL-3.0-or-later
// In how many pieces the solid of a field is, and how many tunnels lead through it: holes through walls, and the
// openings between bridges over gaps.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "verdict/private/bit_slice.hpp"
#include "verdict/private/pieces.hpp"

namespace vam::verdict {

struct FieldShape {
  std::int64_t pieces = 0;  // of so many voxels or more that reach the level
  std::int64_t tunnels = 0;
};

/// Counts pieces and tunnels of the solid in which a field, linear in x, y and z between the centres of voxels, reaches
/// a level > 0; slice by slice, from the lowest up. Its tunnels are pieces + cavities - Euler characteristic, cavities
/// being the pieces of the rest that are closed in. What hangs together across a face between four voxels its saddle
/// tells [NIE91], and inside a cell between eight that of a section [CHE95]. Beyond the volume the field is 0. Memory:
/// three slices, and of those that are not yet connected a bit a voxel.
class FieldCounter {
 public:
  FieldCounter(int width, int height, double level, std::int64_t least_voxels = PrintPieces::least_voxels)
      : width_(width), height_(height), level_(level), solid_(least_voxels) {}
  /// The next slices, row-major, one after the other, on all threads.
  void add(int count, const float* slices);
  /// Takes in what was added; other threads may do so for other fields.
  void connect();
  /// Of all slices, after connect().
  [[nodiscard]] FieldShape found() const;

 private:
  /// A corner of a cell between two slices, in the volume or its margin of one voxel.
  struct Corner {
    int x, y;
    bool above;
  };
  /// Corners that are connected through the cell, not along its edges.
  struct Join {
    Corner from, to;
    bool solid;
  };
  /// A slice, and the cells between the one below and it.
  struct Layer {
    BitSlice solid;
    std::vector<Join> joins;
    std::int64_t euler = 0;
  };
  [[nodiscard]] Layer layer(const float* below, const float* above) const;
  static void add_cell(const std::array<float, 8>& values, double level, int x, int y, Layer& layer);
  void connect(const Layer& layer);

  int width_, height_;
  double level_;
  std::vector<float> last_;  // empty: there is none
  std::vector<Layer> added_;
  PieceCounter solid_, rest_{0};
  bool begun_ = false;  // what lies below the volume is connected
  std::int64_t euler_ = 0;
};

}  // namespace vam::verdict
