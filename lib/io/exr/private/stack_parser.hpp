// SPDX-License-Identifier: GPL-3.0-or-later
// Private to the EXR files, in the process that parses them: the headers are parsed by OpenEXR from memory, the chunks
// are taken in the order of the stream, and the pixels of one image at a time are decoded by OpenEXR from memory. So a
// pipe does, memory is one image whatever the number of parts (Imf::MultiPartInputFile keeps the buffers of every part
// it has opened), and no size is believed before it is checked.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "base/image.hpp"
#include "io/exr/private/format.hpp"
#include "io/exr/private/seals.hpp"
#include "io/stream/stream.hpp"
#include "model/stack.hpp"

namespace vam::io::exr {

/// Of a stack after the other on one stream. All throw std::runtime_error, to stand behind the file's name, for what is
/// no stack, and what OpenEXR throws.
class StackParser {
 public:
  /// to_end: read_head() looks where the last image of a file ends, too, which next() would find.
  StackParser(const std::string& path, bool several, bool to_end = false)
      : in_(path), several_(several), to_end_(to_end) {}

  /// Parses the headers. Once for each stack, before what follows.
  void read_head();
  /// The next image; false after the last.
  bool next(Image& image, model::ImageInfo& about);
  /// After the last image: whether a stack follows.
  bool next_stack() { return !in_.at_end(); }

  [[nodiscard]] InputFile& file() { return in_; }
  [[nodiscard]] const model::StackInfo& info() const { return info_; }
  [[nodiscard]] const std::vector<model::ImageInfo>& about() const { return about_; }
  [[nodiscard]] const SealCheck& seals() const { return *seals_; }

 private:
  struct Arriving {
    Chunks chunks;
    int missing = 0;
  };

  [[nodiscard]] bool multi_part() const { return (flags_ & multi_part_flag) != 0; }
  void begin();
  [[noreturn]] void refuse_foreign(std::int32_t first);  // its first bytes
  void add_part(const Imf::Header& header);
  void require_end(std::uint64_t last);
  void require_clean_end();
  [[noreturn]] static void refuse_rest(std::uint64_t from);
  Arriving complete_part();
  void take_chunk();
  void take(void* to, std::size_t size);
  template <class Number>
  Number take_number() {
    Number value{};
    take(&value, sizeof value);
    return value;
  }

  InputFile in_;
  bool several_;
  bool to_end_;
  model::StackInfo info_;
  std::vector<model::ImageInfo> about_;
  std::int32_t flags_ = 0;
  int announced_ = 0;                   // vam:count, 0 where it is absent
  std::vector<Layout> layouts_;         // distinct ones; nearly always one
  std::vector<std::size_t> layout_of_;  // of every part
  std::map<std::size_t, Arriving> arriving_;
  std::size_t waiting_bytes_ = 0;
  std::optional<SealCheck> seals_;  // of this stack
  std::uint64_t begin_ = 0;         // of the stack on the stream
  std::size_t complete_ = 0;        // parts taken off the stream
  std::string emptied_;             // of chunks, whose memory the next take
};

}  // namespace vam::io::exr
