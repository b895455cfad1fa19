// SPDX-License-Identifier: GPL-3.0-or-later
// The multi-part file is put together here and not by Imf::MultiPartOutputFile, which holds the buffers of all parts at
// once (5,000 parts of ZIP take 1 GB) and seeks back to fill its offset tables: an uncompressed chunk is always 12 +
// row bytes, so the tables can be sent ahead of the pixels and a pipe carries a valid, complete file.
#include <OpenEXR/ImfPartType.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include "base/compute/parallel.hpp"
#include "base/error.hpp"
#include "base/index.hpp"
#include "base/scratch_file.hpp"
#include "base/text/format_version.hpp"
#include "base/text/text.hpp"
#include "io/exr/private/attributes.hpp"
#include "io/exr/private/format.hpp"
#include "io/exr/private/seals.hpp"
#include "io/exr/stack.hpp"
#include "io/stream/finite.hpp"
#include "io/stream/stream.hpp"

namespace vam::io {

namespace {

using model::ImageInfo;
using model::StackInfo;

constexpr float largest_half = 65504;
constexpr std::size_t batch = 16;  // images compressed at a time, in parallel

Imf::Compression compression_named(const std::string& name) {
  static const std::map<std::string, Imf::Compression> known = {
      {"none", Imf::NO_COMPRESSION},   {"rle", Imf::RLE_COMPRESSION}, {"zip", Imf::ZIP_COMPRESSION},
      {"zips", Imf::ZIPS_COMPRESSION}, {"piz", Imf::PIZ_COMPRESSION}, {"pxr24", Imf::PXR24_COMPRESSION}};
  const auto found = known.find(name);
  if (found != known.end()) return found->second;
  throw Error{Fault::usage, "compression '" + name + "' is not known; use none, rle, zip, zips, piz or pxr24"};
}

bool same(const ImageInfo& a, const ImageInfo& b) {
  return a.z_mm == b.z_mm && a.has_angle == b.has_angle && a.has_time == b.has_time &&
         (!a.has_angle || a.angle_deg == b.angle_deg) && (!a.has_time || a.time_s == b.time_s) &&
         a.time_sigma_s == b.time_sigma_s && a.has_number == b.has_number && a.number == b.number &&
         a.incomplete == b.incomplete;
}

void check_half(const Image& image, const std::string& what) {
  float largest = 0;
  for (const float value : image.values) largest = std::max(largest, std::abs(value));
  if (largest <= largest_half) return;
  throw Error{Fault::data, what + " has the value " + format_number(largest) +
                               ", but the half-float maximum is 65504; store 32-bit floats"};
}

std::vector<ImageInfo> all_implied(const StackInfo& info) {
  std::vector<ImageInfo> about;
  for (int i = 0; i < info.count; ++i) about.push_back(exr::implied(info, i));
  return about;
}

}  // namespace

struct StackWriter::State {
  State(const std::string& path, const StackInfo& stack, std::vector<ImageInfo> facts, const StackOptions& options)
      : out(path),
        info(stack),
        about(std::move(facts)),
        type(options.half ? Imf::HALF : Imf::FLOAT),
        compression(compression_named(options.compression)),
        late(options.late) {
    info.extra[version_name] = FormatKind("stack").version();
    if (out.is_stream()) compression = Imf::NO_COMPRESSION;
    if (!exr::is_size(info.width, info.height) || info.count < 1 ||
        about.size() != static_cast<std::size_t>(info.count)) {
      throw Error{Fault::data, out.name() + ": a stack of " + std::to_string(info.count) + " images of " +
                                   std::to_string(info.width) + " x " + std::to_string(info.height) +
                                   " pixels cannot be written; at most 65536 per axis and 2^28 in all"};
    }
    if (const std::string why = exr::implausible(info); !why.empty()) {
      throw Error{Fault::data, out.name() + ": " + why + "; check the geometry"};
    }
  }

  // Magic, version, all headers and all tables: all that stands before the first chunk. It is handed on by the MiB, as
  // 50,000 images have 60 MiB of headers and, with 360 rows each, 140 MiB of tables.
  template <class Take>
  void for_head(const Take& take) const {
    constexpr std::size_t block = std::size_t{1} << 20U;
    const int chunks = exr::chunk_count(info.height, compression);
    Imf::Header header = exr::layout_header(info.width, info.height, type, compression);
    header.setType(Imf::SCANLINEIMAGE);
    header.setChunkCount(chunks);
    exr::set_common(header, info);
    std::int32_t flags = exr::version | exr::multi_part_flag;
    for (const auto& [name, value] : info.extra) {
      if (name.size() > 31) flags |= exr::long_names_flag;
    }
    std::string bytes;
    const auto hand_on = [&](std::size_t from) {
      if (bytes.size() < from) return;
      take(bytes);
      bytes.clear();
    };
    exr::append(bytes, exr::magic);
    exr::append(bytes, flags);
    for (int i = 0; i < info.count; ++i) {
      exr::set_own(header, info, i, about[i]);
      exr::set_seals(header, exr::facts_digest(info, i, about[i]), trailing ? std::nullopt : std::optional(seals[i]));
      bytes += exr::serialize(header);
      hand_on(block);
    }
    bytes += '\0';
    for (std::size_t chunk = 0; chunk < about.size() * static_cast<std::size_t>(chunks); ++chunk) {
      exr::append(bytes, offset(chunk));
      hand_on(block);
    }
    hand_on(1);
  }

  [[nodiscard]] std::size_t count_head() const {
    std::size_t size = 0;
    for_head([&](const std::string& bytes) { size += bytes.size(); });
    return size;
  }

  /// Where a chunk stands. Those that are not compressed are of one size.
  [[nodiscard]] std::uint64_t offset(std::size_t chunk) const {
    if (!offsets.empty()) return offsets[chunk];
    const std::size_t pixel = type == Imf::HALF ? 2 : sizeof(float);
    return head_bytes + chunk * (12 + static_cast<std::uint64_t>(info.width) * pixel);
  }

  // The first image settles which facts the headers hold; their values can still be filled in later where the output
  // can be rewritten.
  void settle(const ImageInfo& own) {
    settled = true;
    const bool late_facts = late || !same(own, about.front());
    for (ImageInfo& each : about) {
      each.has_angle = own.has_angle;
      each.has_time = own.has_time;
      each.has_number = own.has_number;
    }
    if (compression != Imf::NO_COMPRESSION) {
      offsets.resize(static_cast<std::size_t>(exr::chunk_count(info.height, compression)) * about.size());
    }
    seals.resize(about.size());
    trailing = out.is_stream() && !late_facts;
    head_bytes = count_head();
    position = head_bytes;
    if (out.is_stream() && late_facts) {
      spool.emplace();
      return;
    }
    for_head([this](const std::string& bytes) { out.write(bytes); });
  }

  void put(const Image& image, const ImageInfo& own) {
    const std::string what = out.name() + ": image " + std::to_string(done);
    if (done >= about.size() || image.width != info.width || image.height != info.height) {
      throw Error{Fault::bug, what + " does not belong to the " + std::to_string(info.count) + " announced"};
    }
    if (const std::string why = exr::objection(image, done, info.space); !why.empty()) {
      const bool finite = all_finite(image.values.data(), image.size());
      throw Error{finite ? Fault::data : Fault::bug, out.name() + ": " + why};
    }
    if (type == Imf::HALF) check_half(image, what);
    if (!settled) settle(own);
    if (!same(own, about[done])) {
      const ImageInfo& promised = about[done];
      if (own.has_angle != promised.has_angle || own.has_time != promised.has_time ||
          own.has_number != promised.has_number || (out.is_stream() && !spool)) {
        throw Error{Fault::bug, what + " has other facts than announced"};
      }
      about[done] = own;
    }
    waiting.push_back(image);
    ++done;
    if (waiting.size() == (compression == Imf::NO_COMPRESSION ? 1 : batch) || done == about.size()) flush();
  }

  void flush() {
    std::vector<exr::Chunks> encoded(waiting.size());
    std::size_t part = done - waiting.size();
    parallel_for(count_of(waiting), [&](int i) {
      const auto at = static_cast<std::size_t>(i);
      encoded[at] = exr::encode(waiting[at], type, compression);
      seals[part + at] = exr::stored_digest(waiting[at], type, compression, encoded[at]);
    });
    for (const exr::Chunks& image : encoded) {
      std::string bytes;
      bytes.reserve(image.bytes.size() + 4 * image.starts.size());
      for (std::size_t chunk = 0; chunk < image.starts.size(); ++chunk) {
        if (!offsets.empty()) offsets[part * image.starts.size() + chunk] = position + bytes.size();
        const auto size = exr::number_at<std::int32_t>(image.bytes, image.starts[chunk] + 4);
        exr::append(bytes, static_cast<std::int32_t>(part));
        bytes.append(image.bytes, image.starts[chunk], 8 + size);
      }
      send(bytes);
      ++part;
    }
    waiting.clear();
    if (trailing && done == about.size()) out.write(exr::trailer(seals));
  }

  void send(const std::string& bytes) {
    if (spool) {
      spool->write(position - head_bytes, bytes.data(), bytes.size());
    } else {
      out.write(bytes);
    }
    position += bytes.size();
  }

  void finish() {
    if (done != about.size()) {
      throw Error{Fault::bug, out.name() + ": " + std::to_string(done) + " images of the " +
                                  std::to_string(info.count) + " announced"};
    }
    if (count_head() != head_bytes) throw Error{Fault::bug, out.name() + ": the header changed its size"};
    if (spool) {
      for_head([this](const std::string& bytes) { out.write(bytes); });
      std::vector<char> buffer(std::size_t{1} << 20);
      for (std::uint64_t at = 0, end = position - head_bytes; at < end; at += buffer.size()) {
        buffer.resize(std::min<std::uint64_t>(buffer.size(), end - at));
        spool->read(at, buffer.data(), buffer.size());
        out.write(buffer.data(), buffer.size());
      }
    } else if (!out.is_stream()) {
      std::size_t at = 0;
      for_head([&](const std::string& bytes) {
        out.write_at(at, bytes.data(), bytes.size());
        at += bytes.size();
      });
    }
    out.commit();
  }

  OutputFile out;
  StackInfo info;
  std::vector<ImageInfo> about;
  Imf::PixelType type;
  Imf::Compression compression;
  std::vector<std::uint64_t>
      offsets;                 // of every chunk of every part, from the start of the file; empty: not compressed
  std::uint64_t position = 0;  // of the next chunk
  std::size_t head_bytes = 0;
  std::vector<Digest> seals;  // of the values, a part
  bool late = false;          // some facts of the stack come after its images
  bool trailing = false;      // the seals follow the pixels
  bool settled = false;       // the first image has decided what the headers hold
  std::vector<Image> waiting;
  std::size_t done = 0;  // images taken in
  std::optional<ScratchFile> spool;
};

StackWriter::StackWriter(const std::string& path, const StackInfo& info, const StackOptions& options)
    : StackWriter(path, info, all_implied(info), options) {}
StackWriter::StackWriter(const std::string& path, const StackInfo& info, std::vector<ImageInfo> about,
                         const StackOptions& options)
    : state_(std::make_unique<State>(path, info, std::move(about), options)) {}
StackWriter::~StackWriter() = default;

void StackWriter::write(const Image& image) {
  const auto& about = state_->about;
  write(image, about[std::min(state_->done, about.size() - 1)]);
}
void StackWriter::write(const Image& image, const ImageInfo& about) { state_->put(image, about); }
void StackWriter::state(const model::Metadata& facts) {
  if (state_->settled && state_->out.is_stream() && !state_->spool)
    throw Error{Fault::bug,
                state_->out.name() + ": facts behind a header that was sent; StackOptions::late is missing"};
  for (const auto& [name, value] : facts) state_->info.extra.at(name) = value;
}
void StackWriter::commit() { state_->finish(); }

}  // namespace vam::io
