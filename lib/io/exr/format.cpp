// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/exr/private/format.hpp"

#include <Imath/half.h>
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfIO.h>
#include <OpenEXR/ImfVersion.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "base/text/printable.hpp"
#include "base/text/text.hpp"

namespace vam::io::exr {

namespace {

class MemoryReader : public Imf::IStream {
 public:
  explicit MemoryReader(const std::string& bytes) : Imf::IStream("memory"), bytes_(bytes) {}
  bool read(char to[], int size) override {
    const auto wanted = static_cast<std::size_t>(size);
    if (size < 0 || at_ > bytes_.size() || wanted > bytes_.size() - at_) throw std::runtime_error("ends too early");
    std::memcpy(to, bytes_.data() + at_, wanted);
    at_ += wanted;
    end_ = std::max(end_, at_);
    return at_ < bytes_.size();
  }
  std::uint64_t tellg() override { return at_; }
  void seekg(std::uint64_t at) override { at_ = at; }
  /// Of all that was read.
  [[nodiscard]] std::uint64_t end() const { return end_; }

 private:
  const std::string& bytes_;
  std::uint64_t at_ = 0;
  std::uint64_t end_ = 0;
};

class MemoryWriter : public Imf::OStream {
 public:
  MemoryWriter() : Imf::OStream("memory") {}
  void write(const char from[], int size) override {
    const auto count = static_cast<std::size_t>(size);
    if (at_ + count > bytes.size()) bytes.resize(at_ + count);
    std::memcpy(bytes.data() + at_, from, count);
    at_ += count;
  }
  std::uint64_t tellp() override { return at_; }
  void seekp(std::uint64_t at) override { at_ = at; }
  std::string bytes;

 private:
  std::uint64_t at_ = 0;
};

Imf::Slice float_slice(const float* pixels, const Imath::Box2i& window) {
  const auto width = static_cast<std::size_t>(window.max.x - window.min.x) + 1;
  return Imf::Slice::Make(Imf::FLOAT, pixels, window, sizeof(float), width * sizeof(float));
}

}  // namespace

int rows_per_chunk(Imf::Compression compression) {
  switch (compression) {
    case Imf::ZIP_COMPRESSION:
    case Imf::PXR24_COMPRESSION:
      return 16;
    case Imf::PIZ_COMPRESSION:
    case Imf::B44_COMPRESSION:
    case Imf::B44A_COMPRESSION:
    case Imf::DWAA_COMPRESSION:
      return 32;
    case Imf::DWAB_COMPRESSION:
      return 256;
    default:
      return 1;
  }
}

int chunk_count(int height, Imf::Compression compression) {
  const int rows = rows_per_chunk(compression);
  return (height + rows - 1) / rows;
}

std::string take_header(const std::function<void(char*, std::size_t)>& take) {
  std::string bytes;
  const auto take_bytes = [&](std::size_t size) {
    if (size > max_header_bytes - bytes.size()) throw std::runtime_error("its header is too large");
    const std::size_t at = bytes.size();
    bytes.resize(at + size);
    take(bytes.data() + at, size);
  };
  const auto take_name = [&] {
    for (std::size_t length = 0; length < 256; ++length) {
      take_bytes(1);
      if (bytes.back() == '\0') return length;
    }
    throw std::runtime_error("its header has an endless name");
  };
  while (take_name() > 0) {
    take_name();  // of the type
    take_bytes(sizeof(std::int32_t));
    const auto size = number_at<std::int32_t>(bytes, bytes.size() - sizeof(std::int32_t));
    if (size < 0) throw std::runtime_error("its header has an attribute of negative size");
    take_bytes(size);
  }
  if (bytes.size() == 1) bytes.clear();
  return bytes;
}

Imf::Header parse_header(const std::string& bytes, int file_version) {
  MemoryReader reader(bytes);
  Imf::Header header;
  header.readFrom(reader, file_version);
  return header;
}

std::string serialize(const Imf::Header& header) {
  MemoryWriter writer;
  header.writeTo(writer);
  return std::move(writer.bytes);
}

Imf::Header layout_header(int width, int height, Imf::PixelType type, Imf::Compression compression) {
  Imf::Header header(width, height);
  header.compression() = compression;
  header.channels().insert(channel, Imf::Channel(type));
  return header;
}

Chunks encode(const Image& image, Imf::PixelType type, Imf::Compression compression) {
  // The chunks of a part are those of a single-part file of the same image, whatever the rest of the file holds.
  const Imf::Header layout = layout_header(image.width, image.height, type, compression);
  MemoryWriter writer;
  std::vector<half> halves;
  {
    Imf::OutputFile file(writer, layout, 0);
    Imf::FrameBuffer pixels;
    if (type == Imf::HALF) {
      halves.assign(image.values.begin(), image.values.end());
      pixels.insert(channel, Imf::Slice::Make(Imf::HALF, halves.data(), layout.dataWindow()));
    } else {
      pixels.insert(channel, float_slice(image.values.data(), layout.dataWindow()));
    }
    file.setFrameBuffer(pixels);
    file.writePixels(image.height);
  }
  std::size_t at = 8;
  const std::string header = take_header([&](char* to, std::size_t size) {
    std::memcpy(to, writer.bytes.data() + at, size);
    at += size;
  });
  const auto count = static_cast<std::size_t>(chunk_count(image.height, compression));
  const std::size_t begin = at + count * sizeof(std::uint64_t);
  Chunks chunks;
  for (std::size_t i = 0; i < count; ++i) {
    const auto start = number_at<std::uint64_t>(writer.bytes, at + i * sizeof(std::uint64_t));
    chunks.starts.push_back(static_cast<std::size_t>(start) - begin);
  }
  chunks.bytes = writer.bytes.substr(begin);
  return chunks;
}

void decode(const Imf::Header& layout, const Chunks& chunks, Image& image) {
  if (has_plain_rows(layout)) return decode_rows(layout, chunks, image);
  std::string file;
  append(file, magic);
  append(file, version | long_names_flag);
  file += serialize(layout);
  const std::size_t begin = file.size() + chunks.starts.size() * sizeof(std::uint64_t);
  for (const std::size_t start : chunks.starts) append(file, static_cast<std::uint64_t>(begin + start));
  file += chunks.bytes;

  MemoryReader reader(file);
  Imf::InputFile input(reader, 0);
  const auto& window = layout.dataWindow();
  Imf::FrameBuffer pixels;
  pixels.insert(channel, float_slice(image.values.data(), window));
  input.setFrameBuffer(pixels);
  input.readPixels(window.min.y, window.max.y);
}

std::string channel_remedy(const Imf::ChannelList& channels) {
  if (channels.begin() == channels.end()) return "write it again";
  const std::string name = printable(channels.findChannel("R") != nullptr ? "R" : channels.begin().name());
  return "to take " + name + ": oiiotool -a FILE --ch 'Y=" + name + "' -o FILE.Y.exr";
}

void require_whole(const Imf::Header& header) {
  if (header.dataWindow() != header.displayWindow())
    throw std::runtime_error("has pixels for a part of its image only; oiiotool FILE --croptofull -o FILE.full.exr");
  if (const auto aspect = static_cast<double>(header.pixelAspectRatio()); std::abs(aspect - 1) > 1e-3)
    throw std::runtime_error("has pixels " + format_number(aspect, 3) + " times as wide as high; resample it, or if " +
                             "its header is wrong: oiiotool FILE --attrib PixelAspectRatio 1 -o FILE.square.exr");
}

namespace {

std::string only_channel(const Imf::Header& header) {
  std::string names;
  std::size_t count = 0;
  for (auto one = header.channels().begin(); one != header.channels().end(); ++one, ++count) {
    if (one.name() == std::string(channel)) return channel;
    names += (count == 0 ? "" : ", ") + printable(one.name());
  }
  if (count == 1 && (names.ends_with("Z") || names.ends_with("depth")))
    throw std::runtime_error("has depths alone (" + names +
                             "); if they are intensities: oiiotool FILE --chnames Y -o FILE.Y.exr");
  if (count == 1) return header.channels().begin().name();
  throw std::runtime_error("has the channels " + names + "; one of intensity is read (Y); " +
                           channel_remedy(header.channels()));
}

}  // namespace

Image decode_single(const std::string& bytes) {
  MemoryReader stream(bytes);
  Imf::InputFile file(stream, 0);
  const Imf::Header& header = file.header();
  const Imath::Box2i window = header.dataWindow();
  require_whole(header);
  const std::int64_t width = std::int64_t{window.max.x} - window.min.x + 1;
  const std::int64_t height = std::int64_t{window.max.y} - window.min.y + 1;
  if (!is_size(width, height)) {
    throw std::runtime_error("has " + std::to_string(width) + " x " + std::to_string(height) + " pixels, too many");
  }
  const std::string name = only_channel(header);
  Image image(static_cast<int>(width), static_cast<int>(height));
  Imf::FrameBuffer pixels;
  pixels.insert(name, float_slice(image.values.data(), window));
  file.setFrameBuffer(pixels);
  file.readPixels(window.min.y, window.max.y);
  // Smaller copies of tiled images, and other parts, are of the file but not read.
  const bool all_read = !header.hasTileDescription() && !Imf::isMultiPart(file.version());
  if (all_read && stream.end() < bytes.size()) {
    throw std::runtime_error("has " + std::to_string(bytes.size() - stream.end()) +
                             " bytes behind the end of its EXR image; it is damaged, or holds several images");
  }
  return image;
}

}  // namespace vam::io::exr
