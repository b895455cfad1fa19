// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/exr/private/stack_parser.hpp"

#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <new>
#include <stdexcept>
#include <utility>

#include "base/index.hpp"
#include "base/text/format_version.hpp"
#include "io/exr/private/attributes.hpp"
#include "io/stream/file_type.hpp"

namespace vam::io::exr {

namespace {

using model::ImageInfo;
using model::StackInfo;

// Parts may be interleaved; what has come too early waits in memory up to here.
constexpr std::size_t max_waiting_bytes = std::size_t{1} << 30;
constexpr std::size_t absent = ~std::size_t{0};

void decode_whole(const Imf::Header& layout, const Chunks& chunks, std::size_t index, Image& image) {
  try {
    decode(layout, chunks, image);
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& problem) {
    throw std::runtime_error("image " + std::to_string(index) + " is damaged: " + problem.what() + "; create it again");
  }
}

// In the memory of an earlier image; all of it is decoded anew.
void take_size(Image& image, const StackInfo& info) {
  image.width = info.width;
  image.height = info.height;
  image.values.resize(product(info.width, info.height));
}

void require_own_poses(const StackInfo& info) {
  if (info.poses.empty()) return;
  if (info.poses.size() != static_cast<std::size_t>(info.height)) {
    throw std::runtime_error("vam:poses has " + std::to_string(info.poses.size()) + " lines, but the images have " +
                             std::to_string(info.height) + " angles");
  }
  if (const std::string why = objection(info.poses, info.angle_start_deg, info.angle_step_deg); !why.empty()) {
    throw std::runtime_error("vam:poses: " + why);
  }
}

}  // namespace

void StackParser::take(void* to, std::size_t size) {
  if (in_.read(to, size) == size) return;
  std::string where = "in its header";
  if (info_.count > 0) where = "in image " + std::to_string(complete_) + " of " + std::to_string(info_.count);
  throw std::runtime_error("is cut off after " + std::to_string(in_.position()) + " bytes, " + where +
                           "; the program that wrote it did not finish");
}

// Magic and flags.
void StackParser::begin() {
  info_ = {};
  about_.clear();
  layouts_.clear();
  layout_of_.clear();
  arriving_.clear();
  seals_.emplace();
  waiting_bytes_ = 0;
  complete_ = 0;
  begin_ = in_.position();
  if (in_.at_end()) throw std::runtime_error("is empty; the program that should have written it failed");
  std::int32_t first = 0;
  if (in_.read(&first, sizeof first) != sizeof first || first != magic) refuse_foreign(first);
  flags_ = take_number<std::int32_t>();
  if ((flags_ & 0xff) != version) throw std::runtime_error("is of an OpenEXR version that is not known");
  if ((flags_ & (tiled_flag | deep_flag)) != 0) throw std::runtime_error("holds tiles or deep pixels");
}

void StackParser::refuse_foreign(std::int32_t first) {
  std::string more(400, '\0');
  more.resize(in_.read(more.data(), more.size()));
  const std::string head = std::string(reinterpret_cast<const char*>(&first), sizeof first) + more;
  const std::string foreign = foreign_format(head);
  throw std::runtime_error(foreign.empty() ? "is not OpenEXR"
                                           : "is " + foreign + ", not a stack (OpenEXR)" + foreign_remedy(head));
}

void StackParser::read_head() {
  begin();
  const auto take_bytes = [this](char* to, std::size_t size) { take(to, size); };
  for (std::string bytes = take_header(take_bytes); !bytes.empty(); bytes = take_header(take_bytes)) {
    add_part(parse_header(bytes, flags_));
    if (!multi_part()) break;
  }
  if (about_.empty()) throw std::runtime_error("has no image");
  const int parts = count_of(about_);
  if (announced_ != 0 && announced_ != parts) {
    throw std::runtime_error("holds " + std::to_string(parts) + " of the " + std::to_string(announced_) +
                             " images that vam:count announces");
  }
  info_.count = parts;
  if (!info_.piece.whole() && info_.piece.images.count() != parts) {
    throw std::runtime_error("holds " + std::to_string(parts) + " images, but vam:piece is '" +
                             model::piece_text(info_.piece) + "'");
  }
  require_pitch(info_);

  // The offset tables serve those who seek; here the chunks say themselves what they are.
  std::uint64_t last = 0;
  std::uint64_t least = std::numeric_limits<std::uint64_t>::max();
  for (const std::size_t layout : layout_of_) {
    for (int i = 0; i < layouts_[layout].chunks; ++i) {
      const auto offset = take_number<std::uint64_t>();
      seals_->note_offset(offset);
      last = std::max(last, offset);
      least = std::min(least, offset);
    }
  }
  // Other programs may have left out the table.
  if (to_end_ && in_.size() > 0 && (least > 0 || seals_->sealed())) require_end(last);
  const std::string line = seals_->chained();
  const bool named = !info_.history.empty() && !chained_seal(info_.history.back()).empty();
  if (!line.empty() && !named) info_.history.push_back(line);
}

void StackParser::add_part(const Imf::Header& header) {
  require_version(header);
  Layout layout = checked_layout(header);
  if (about_.empty()) {
    info_ = stack_info(header);
    info_.extra.erase(version_name);  // of this file
    info_.width = layout.width;
    info_.height = layout.height;
    announced_ = std::exchange(info_.count, 0);
    if (info_.kind == model::Kind::sinogram) require_own_poses(info_);
  }
  const std::string part = "part " + std::to_string(about_.size());
  if (layout.width != info_.width || layout.height != info_.height) {
    throw std::runtime_error(part + " has another size than part 0");
  }
  about_.push_back(image_info(header, info_, count_of(about_)));
  StackInfo own = stack_info(header);
  own.width = layout.width;
  own.height = layout.height;
  seals_->begin_part(header, multi_part(), own, about_.back());
  require_alike(header, info_, own, count_of(about_) - 1);
  const auto known =
      std::find_if(layouts_.begin(), layouts_.end(), [&](const Layout& l) { return l.key == layout.key; });
  layout_of_.push_back(static_cast<std::size_t>(known - layouts_.begin()));
  if (known == layouts_.end()) layouts_.push_back(std::move(layout));
}

void StackParser::take_chunk() {
  const std::uint64_t start = in_.position() - begin_;
  const std::int32_t part = multi_part() ? take_number<std::int32_t>() : 0;
  const auto y = take_number<std::int32_t>();
  const auto size = take_number<std::int32_t>();
  const auto index = static_cast<std::size_t>(part);
  if (part < 0 || index >= layout_of_.size() || index < complete_) throw std::runtime_error("has a chunk of no part");
  const Layout& layout = layouts_[layout_of_[index]];
  const std::int64_t row = std::int64_t{y} - layout.header.dataWindow().min.y;
  const int rows = rows_per_chunk(layout.header.compression());
  const auto place = static_cast<std::size_t>(row / rows);
  Arriving& image = arriving_[index];
  if (image.chunks.starts.empty()) {
    image.chunks.bytes = std::move(emptied_);
    image.chunks.bytes.clear();
    image.chunks.starts.assign(layout.chunks, absent);
    image.missing = layout.chunks;
  }
  if (row < 0 || row >= layout.height || row % rows != 0 || image.chunks.starts[place] != absent || size < 0 ||
      static_cast<std::size_t>(size) > layout.max_chunk_bytes) {
    throw std::runtime_error("image " + std::to_string(index) + " has a damaged chunk near byte " +
                             std::to_string(in_.position()));
  }
  // The table's order is part by part, row by row.
  const bool in_order =
      index == complete_ && place + static_cast<std::size_t>(image.missing) == image.chunks.starts.size();
  seals_->note_chunk(start, in_order);
  std::string& bytes = image.chunks.bytes;
  image.chunks.starts[place] = bytes.size();
  append(bytes, y);
  append(bytes, size);
  const std::size_t at = bytes.size();
  bytes.resize(at + size);
  take(bytes.data() + at, size);
  --image.missing;
  waiting_bytes_ += bytes.size() - at + 8;
  if (waiting_bytes_ > max_waiting_bytes && index != complete_) {
    throw std::runtime_error("has its parts interleaved; exrmultipart -combine puts them in order");
  }
}

StackParser::Arriving StackParser::complete_part() {
  while (arriving_[complete_].chunks.starts.empty() || arriving_[complete_].missing > 0) take_chunk();
  Arriving image = std::move(arriving_[complete_]);
  arriving_.erase(complete_);
  waiting_bytes_ -= image.chunks.bytes.size();
  ++complete_;
  return image;
}

bool StackParser::next(Image& image, ImageInfo& about) {
  if (complete_ == about_.size()) return false;
  const std::size_t index = complete_;
  about = about_[index];
  Chunks chunks = complete_part().chunks;
  take_size(image, info_);
  decode_whole(layouts_[layout_of_[index]].header, chunks, index, image);
  emptied_ = std::move(chunks.bytes);
  const bool as_written = seals_->note_image(index, image);  // when the writer looked at the values
  if (const std::string why = as_written ? "" : objection(image, index, info_.space); !why.empty()) {
    throw std::runtime_error(why);
  }
  seals_->judge(index);
  if (complete_ < about_.size()) return true;
  seals_->finish([this](char* to, std::size_t size) { take(to, size); });
  require_clean_end();
  return true;
}

// By the offset of the last chunk, of whose image nothing else is read.
void StackParser::require_end(std::uint64_t last) {
  const off_t here = lseek(in_.descriptor(), 0, SEEK_CUR);
  const std::uint64_t start = static_cast<std::uint64_t>(here) - in_.buffered() - in_.position() + begin_;
  const auto read_at = [&](std::uint64_t from, void* to, std::size_t size) {
    const bool done = from < in_.size() && lseek(in_.descriptor(), static_cast<off_t>(from), SEEK_SET) >= 0 &&
                      ::read(in_.descriptor(), to, size) == static_cast<ssize_t>(size);
    (void)lseek(in_.descriptor(), here, SEEK_SET);
    return done;
  };
  struct {
    std::int32_t row, size;
  } chunk{};
  const std::uint64_t head = start + last + (multi_part() ? sizeof(std::int32_t) : 0);
  const bool there = last < in_.size() && read_at(head, &chunk, sizeof chunk) && chunk.size >= 0;
  std::uint64_t end = head + sizeof chunk + static_cast<std::uint64_t>(there ? chunk.size : 0);
  if (seals_->follow()) end += seal_mark.size() + trailer_bytes(about_.size());
  if (!there || end > in_.size()) {
    throw std::runtime_error("is cut off after " + std::to_string(in_.size()) + " bytes, before the last of its " +
                             std::to_string(info_.count) + " images ends; the program that wrote it did not finish");
  }
  std::int32_t next = 0;
  if (end < in_.size() && !(read_at(end, &next, sizeof next) && next == magic)) refuse_rest(end);
}

// Of several, a pipe is not waited for: its writer may take its time for the next stack. One that is to be the last has
// a second, lest a writer that never closes its end holds up the reader.
void StackParser::require_clean_end() {
  constexpr int patience_ms = 1000;
  pollfd more{in_.descriptor(), POLLIN, 0};
  if (in_.size() == 0 && in_.buffered() == 0 && poll(&more, 1, several_ ? 0 : patience_ms) <= 0) return;
  if (in_.at_end()) return;
  const auto next = in_.peek();
  const std::size_t size = std::min(next.size(), sizeof magic);
  const bool stack = std::memcmp(next.data(), &magic, size) == 0;
  if (stack && several_) return;
  if (stack) {
    throw std::runtime_error("another stack follows the last image, from byte " + std::to_string(in_.position()) +
                             " on, and one is read; write each to a file of its own");
  }
  refuse_rest(in_.position());
}

void StackParser::refuse_rest(std::uint64_t from) {
  throw std::runtime_error("trailing data after the last image, from byte " + std::to_string(from) +
                           " on, is not a stack; write the file again, or truncate it there");
}

}  // namespace vam::io::exr
