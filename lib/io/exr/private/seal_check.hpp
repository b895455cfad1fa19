// SPDX-License-Identifier: GPL-3.0-or-later
// Private to the EXR files: holds a stack to its seals while it is read. A stack without seals passes.
#pragma once

#include <OpenEXR/ImfHeader.h>

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "base/image.hpp"
#include "io/exr/private/seals.hpp"
#include "io/stream/seal.hpp"
#include "model/stack.hpp"

namespace vam::io::exr {

/// Of two lists of numbers that differ in one of them, or in its place, the sums differ.
class OffsetSum {
 public:
  void add(std::uint64_t offset) { sum_ = (sum_ + offset) * 0x9e3779b97f4a7c15U; }  // odd, so that no bit is lost
  friend bool operator==(const OffsetSum&, const OffsetSum&) = default;

 private:
  std::uint64_t sum_ = 0;
};

/// All throw std::runtime_error where something is not as it was written.
class SealCheck {
 public:
  /// Of the next part: its facts are those that were written, and no part of a sealed stack has lost its seals.
  void begin_part(const Imf::Header& header, bool multi_part, const model::StackInfo& own,
                  const model::ImageInfo& about);
  /// The offsets that the tables announce, and where the chunks are; those of other programs may not be in the
  /// tables' order, and are not compared then.
  void note_offset(std::uint64_t announced) { table_.add(announced); }
  void note_chunk(std::uint64_t start, bool in_order);
  /// Whether its values are those of its seal, if that is known yet; it is judged once they are noted.
  bool note_image(std::size_t index, const Image& image);
  void judge(std::size_t index) const;
  /// After the last image; take(to, size) gets the bytes that follow it. A reader need not ask for more than images.
  void finish(const std::function<void(char* to, std::size_t size)>& take);

  /// Whether seals come after the last image.
  [[nodiscard]] bool follow() const { return sealed() && !seals_.front().values; }
  [[nodiscard]] bool sealed() const { return !seals_.empty(); }
  /// What tells this stack from others; empty where it is not sealed, or its seals have not come yet.
  [[nodiscard]] std::string chained() const;

 private:
  std::size_t parts_ = 0;
  std::vector<PartSeals> seals_;  // of every part, or none
  std::vector<Digest> read_;      // of the values that were read
  OffsetSum table_, places_;
  bool in_order_ = true;
};

}  // namespace vam::io::exr
