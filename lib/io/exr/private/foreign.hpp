// SPDX-License-Identifier: GPL-3.0-or-later
// Private to the EXR files: stacks of other programs, and what follows them on a stream, parsed in a child.
#pragma once

#include <vector>

#include "io/exr/private/stack_parser.hpp"
#include "io/stream/sandboxed_reader.hpp"

namespace vam::io::exr {

/// All stacks that the parser has before it, its present one first. It must not be used here any more.
class ForeignStacks {
 public:
  explicit ForeignStacks(StackParser& parser);
  /// The next image; false after the last. Both throw as StackParser does.
  bool next(Image& image, model::ImageInfo& about);
  bool next_stack();

  [[nodiscard]] const model::StackInfo& info() const { return info_; }
  [[nodiscard]] const std::vector<model::ImageInfo>& about() const { return about_; }
  /// As of StackReader: of a stack that follows one without seals.
  [[nodiscard]] const std::string& seal() const { return seal_; }
  [[nodiscard]] bool is_sealed() const { return sealed_; }

 private:
  SandboxedReader apart_;
  std::string name_;
  model::StackInfo info_;
  std::vector<model::ImageInfo> about_;
  std::size_t done_ = 0;
  bool sealed_ = false;
  std::string seal_;
};

}  // namespace vam::io::exr
