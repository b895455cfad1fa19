// SPDX-License-Identifier: GPL-3.0-or-later
// What comes in, slice by slice, whatever it is kept in.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/image.hpp"
#include "io/array/array_file.hpp"
#include "io/image/any_frames.hpp"
#include "model/printer.hpp"
#include "vam-convert/options.hpp"

namespace vam::convert_tool {

class Slices {
 public:
  /// Of an array with these axes for slices, rows and columns, as source() with the pitch of voxels that its file
  /// states; or the images of a folder or video, one a slice. Throws what opening them throws.
  Slices(const Options& options, std::optional<io::FileType> type, const std::string& letters);
  ~Slices();
  [[nodiscard]] const io::ImageSource& source() const { return *source_; }
  /// Are they frames of a projector, row 0 at the top, no array?
  [[nodiscard]] bool are_frames() const { return frames_; }
  /// Takes frames as projections, one a stage angle, of which every slice needs a row: they are held, what is dark in
  /// them left out; levels become intensities by the projector's response where it has one. Throws Fault::memory.
  void collect(const Options& options, const model::Printer& printer);
  /// Slices, rows (angles of projections) and columns.
  [[nodiscard]] io::ArraySize size() const { return size_; }
  /// The greatest level of collected frames, before the projector's response; 0 of others.
  [[nodiscard]] float peak() const { return peak_; }
  /// The first and the last column that are lit in some collected frame; all of others.
  [[nodiscard]] std::pair<int, int> lit() const { return lit_columns_; }
  /// Upwards, divided by --full-scale; false after the last. Throws Fault::data where fewer come than are stated.
  bool next(Image& slice);

 private:
  struct Lit;  // what is not dark of a row
  bool take(Image& image);
  std::string name_;
  double full_scale_;
  bool frames_;
  bool pages_ = false;
  std::unique_ptr<io::ImageSource> source_;
  io::ArraySize size_;
  std::vector<Lit> lit_;
  int taken_ = 0;
  int done_ = 0;
  float peak_ = 0;
  std::pair<int, int> lit_columns_;
};

}  // namespace vam::convert_tool
