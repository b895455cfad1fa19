// SPDX-License-Identifier: GPL-3.0-or-later
// Projections slice by slice: frames, one a stage angle, are collected first.
#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "base/image.hpp"
#include "io/array/array_reader.hpp"
#include "model/printer.hpp"
#include "vam-convert/images.hpp"

namespace vam::convert_tool {

class Slices {
 public:
  /// Frames are held, what is dark in them left out; levels become intensities by the projector's response where it has
  /// one. Throws Fault::memory.
  Slices(std::unique_ptr<Images> images, const Options& options, const model::Printer& printer);
  ~Slices();
  /// Slices, angles and columns.
  [[nodiscard]] io::ArraySize size() const;
  [[nodiscard]] StatedViews views() const { return images_->views(); }
  /// The greatest level of frames, before the projector's response; 0 of arrays.
  [[nodiscard]] float peak() const { return peak_; }
  /// The first and the last column that are lit in some frame; all of arrays.
  [[nodiscard]] std::pair<int, int> lit() const { return lit_columns_; }
  /// Upwards: a row for each angle; false after the last.
  bool next(Image& slice);

 private:
  struct Lit;  // what is not dark of a row
  void collect(const Options& options, const model::Printer& printer);
  std::unique_ptr<Images> images_;
  io::ArraySize size_;
  std::vector<Lit> lit_;
  int done_ = 0;
  float peak_ = 0;
  std::pair<int, int> lit_columns_;
};

}  // namespace vam::convert_tool
