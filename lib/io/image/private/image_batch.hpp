// SPDX-License-Identifier: GPL-3.0-or-later
// Several image files, decoded by one child.
#pragma once

#include <memory>
#include <span>
#include <string>

#include "base/pixels.hpp"

namespace vam::io {

/// Reads the files and starts a child that decodes one after the other, ahead of who takes them.
class ImageBatch {
 public:
  /// Takes the first path and those after it that can be read, up to 128 files of together 64 MiB. Throws what
  /// read_all() throws of the first, and what SandboxedReader does.
  explicit ImageBatch(std::span<const std::string> paths);
  ~ImageBatch();
  [[nodiscard]] int count() const;
  /// The next one, `count` times. Errors of a batch of several name its first file, and the child's bounds are those of
  /// them all: read_image() tells which of them is damaged, and how.
  [[nodiscard]] GreyImage next();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace vam::io
