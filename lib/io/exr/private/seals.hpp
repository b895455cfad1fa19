// SPDX-License-Identifier: GPL-3.0-or-later
// Private to the EXR files: the seals of a stack. Every part bears that of its facts and that of its pixels as they are
// decoded. On a pipe the pixels' come after the last image, where other programs do not look: seal_mark, a Digest a
// part, the Digest of these.
#pragma once

#include <OpenEXR/ImfHeader.h>

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/image.hpp"
#include "io/exr/private/format.hpp"
#include "io/stream/seal.hpp"
#include "model/stack.hpp"

namespace vam::io::exr {

inline constexpr std::string_view seal_mark = "vam:seal";

/// Of the facts of part `index`, of its size and of every vam: attribute.
[[nodiscard]] Digest facts_digest(const model::StackInfo& info, int index, const model::ImageInfo& about);
/// Of the values, row by row, as floats.
[[nodiscard]] Digest values_digest(const Image& image);
/// Of what a reader of `chunks`, which encode() has made of the image, will see.
[[nodiscard]] Digest stored_digest(const Image& image, Imf::PixelType type, Imf::Compression compression,
                                   const Chunks& chunks);

/// No values: they follow on the pipe.
void set_seals(Imf::Header& header, const Digest& facts, const std::optional<Digest>& values);

struct PartSeals {
  Digest facts;
  std::optional<Digest> values;  // none: they follow
};
/// Nothing where the part has none. Throws std::runtime_error where one of the two is missing or damaged.
[[nodiscard]] std::optional<PartSeals> seals_of(const Imf::Header& header, const std::string& part);

/// What follows the last image of a pipe, seal_mark included.
[[nodiscard]] std::string trailer(const std::vector<Digest>& values);
/// Of the bytes after seal_mark. Throws std::runtime_error where they are damaged.
[[nodiscard]] std::vector<Digest> parse_trailer(const std::string& bytes);
[[nodiscard]] inline std::size_t trailer_bytes(std::size_t parts) { return (parts + 1) * sizeof(Digest); }

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
