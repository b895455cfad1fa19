// SPDX-License-Identifier: GPL-3.0-or-later
// Private to the HDF5 files: the images of an open dataset in any order of its axes, many read at a time.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "io/hdf5/private/hdf5_handle.hpp"

namespace vam::io::hdf5 {

/// How a dataset becomes images.
struct Order {
  std::array<std::size_t, 3> axes{0, 1, 2};  // which count the images, rows and columns, where a plane is one slice
  std::vector<std::size_t> rows;             // those of the file that are rows of an image
  bool backwards = false;                    // the last image of the file is the first
};

/// As three axes, the slowest first. Throws Fault::data, beginning with `subject`: other than 2 or 3, no or more than
/// 65536 values along one.
[[nodiscard]] std::array<std::uint64_t, 3> three_axes(const std::vector<std::uint64_t>& shape,
                                                      const std::string& subject);

class Images {
 public:
  /// `memory` bytes for those that are held, at least one. `subject` begins messages.
  Images(hid_t dataset, Order order, std::uint64_t memory, std::string subject);
  /// Images, rows, columns.
  [[nodiscard]] const std::array<std::uint64_t, 3>& size() const { return size_; }
  /// Row by row; false after the last. Throws Fault::data: truncated or damaged.
  bool next(std::vector<float>& image);

 private:
  void plan_depth(std::uint64_t memory);
  void read_block();
  /// The place of the next one along its axis.
  [[nodiscard]] std::uint64_t place() const { return order_.backwards ? size_[0] - 1 - done_ : done_; }

  hid_t dataset_;
  Order order_;
  std::string subject_;
  std::size_t rank_ = 3;
  std::array<std::uint64_t, 3> shape_{};  // of the dataset
  std::array<std::uint64_t, 3> size_{};
  std::uint64_t depth_ = 1;  // images read together
  std::vector<float> block_;
  std::array<std::size_t, 3> stride_{};  // of the axes in it
  std::uint64_t first_ = 0;
  std::uint64_t held_ = 0;
  std::uint64_t done_ = 0;
};

}  // namespace vam::io::hdf5
