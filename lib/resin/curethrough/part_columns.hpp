// SPDX-License-Identifier: GPL-3.0-or-later
// A part as one bit per voxel, each pixel column in one piece, so that both ends of a feature are found from anywhere
// in the column: 1920 x 1080 x 1000 voxels take 260 MB.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "resin/curethrough/column_dose.hpp"

namespace vam::resin {

/// Nodes first..last of a column that are all inside features, or all outside.
struct NodeRun {
  int first = 0;
  int last = 0;
  bool inside = false;
};

/// width x height columns (index y * width + x) of `slices` slices; slice 0 is the one at the platform.
class PartColumns {
 public:
  PartColumns(int width, int height, int slices, ExposureMode exposure);

  /// Slices first .. first + count - 1 of a column, at most 64: slice first + b is in the part where bit b is set.
  void put(std::size_t column, int first, int count, std::uint64_t bits);
  /// Any number of slices of a column, all in the part or all out of it.
  void fill(std::size_t column, int first, int count, bool solid);

  [[nodiscard]] int width() const { return width_; }
  [[nodiscard]] int height() const { return height_; }
  [[nodiscard]] int slices() const { return slices_; }
  [[nodiscard]] int nodes() const { return nodes_; }
  [[nodiscard]] std::size_t columns() const { return pixels_; }

  /// Slices first .. first + count - 1 as dense images, 1 in the part and 0 outside.
  void unpack(int first, int count, float* out) const;
  /// The same of row y alone, slice first + i at out + i * stride.
  void unpack_row(int y, int first, int count, float* out, std::size_t stride) const;

  /// The run that holds this node; a run outside that reaches the last node has last = nodes() - 1.
  [[nodiscard]] NodeRun run(std::size_t column, int node) const;
  /// The first slice >= n that is in the part (or not, when `solid` is false); slices() when there is none.
  [[nodiscard]] int next_slice(std::size_t column, int n, bool solid) const;

 private:
  [[nodiscard]] std::uint64_t bits(std::size_t column, int first) const;
  [[nodiscard]] const std::uint64_t* column_words(std::size_t column) const { return words_.data() + column * stride_; }
  [[nodiscard]] std::uint64_t node_word(const std::uint64_t* words, std::size_t index) const;
  int width_;
  int height_;
  int slices_;
  int nodes_;
  bool planes_;  // a node is a plane between slices
  std::size_t pixels_;
  std::size_t stride_;  // words per column
  std::vector<std::uint64_t> words_;
};

/// What the part asks of a print.
struct PartSurvey {
  std::size_t columns = 0;   // that hold any part
  std::size_t features = 0;  // runs of slices in the part, over all columns
  int last_slice = -1;       // the deepest slice in the part
};
[[nodiscard]] PartSurvey survey(const PartColumns& part);

}  // namespace vam::resin
