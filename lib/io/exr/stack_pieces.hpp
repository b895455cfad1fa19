// SPDX-License-Identifier: GPL-3.0-or-later
// Pieces of a stack, read as the undivided one.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "io/exr/stack.hpp"
#include "model/piece.hpp"

namespace vam::io {

/// A stack, or successive pieces of one: files in any order, or what follows each other on stdin ("-").
class StackPieces {
 public:
  /// Throws what StackReader throws; Fault::data for pieces of different stacks, pieces that overlap or leave a gap,
  /// and several stacks that are no pieces.
  explicit StackPieces(const std::vector<std::string>& paths);
  /// Of the undivided stack, with the history that it has in its own file.
  [[nodiscard]] const model::StackInfo& info() const { return info_; }
  /// The images that the pieces hold; on stdin those up to the last of the undivided stack.
  [[nodiscard]] const model::ImageRange& images() const { return images_; }
  /// Writes these of images(), once. Throws Fault::data where stdin ends before the last of them.
  void copy(const model::ImageRange& wanted, StackWriter& out);

 private:
  struct Part {
    std::string name;
    std::unique_ptr<StackReader> reader;
    model::StackInfo info;
  };
  void require_same(const Part& first, const Part& other) const;
  void require_next(const Part& part) const;
  bool advance();
  [[nodiscard]] bool piped() const;
  bool next(const model::ImageRange& wanted, Image& image, model::ImageInfo& about);

  std::vector<Part> parts_;  // ascending
  std::size_t at_ = 0;
  model::StackInfo info_;
  model::ImageRange images_;
  int done_ = 0;  // the next image
};

/// The facts of these images of a stack. Throws Fault::data for frames with poses, which belong to all of them.
[[nodiscard]] model::StackInfo cut(const model::StackInfo& info, const model::ImageRange& images,
                                   const std::string& name);

}  // namespace vam::io
