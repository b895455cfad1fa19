// SPDX-License-Identifier: GPL-3.0-or-later
// Private to the EXR files: what an OpenEXR file looks like on the wire (openexr.com, "OpenEXR File Layout"), and the
// bridge to the library, which only ever sees memory. A multi-part scanline file is
//   magic, version | header, header, ..., 0 | offset table of every part | chunks (part number, y, size, data)
// and a single-part file is the same with one header, no closing 0 and no part numbers. Numbers are little-endian.
#pragma once

#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputFile.h>   // whole, so that nobody takes io::InputFile and io::OutputFile for what
#include <OpenEXR/ImfOutputFile.h>  // ImfForward.h announces

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <functional>
#include <string>
#include <vector>

#include "base/image.hpp"
#include "model/stack.hpp"

namespace vam::io::exr {

static_assert(std::endian::native == std::endian::little, "EXR numbers are copied as they are");

inline constexpr std::int32_t magic = 20000630;
inline constexpr std::int32_t version = 2;
inline constexpr std::int32_t tiled_flag = 0x200;
inline constexpr std::int32_t long_names_flag = 0x400;  // names of 32 to 255 bytes
inline constexpr std::int32_t deep_flag = 0x800;
inline constexpr std::int32_t multi_part_flag = 0x1000;

inline constexpr const char* channel = "Y";
/// Remedy text for files without channel Y.
std::string channel_remedy(const Imf::ChannelList& channels);
/// Throws std::runtime_error where pixels are missing, or are not square.
void require_whole(const Imf::Header& header);

/// Refused beyond these, before memory is taken.
inline constexpr int max_side = 1 << 16;                           // pixels
inline constexpr std::int64_t max_pixels = std::int64_t{1} << 28;  // of one image: 1 GiB as float
[[nodiscard]] constexpr bool is_size(std::int64_t width, std::int64_t height) {
  return width >= 1 && height >= 1 && width <= max_side && height <= max_side && width * height <= max_pixels;
}
inline constexpr std::size_t max_header_bytes = std::size_t{1} << 24;  // of one part

template <class Number>
void append(std::string& bytes, Number value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

template <class Number>
Number number_at(const std::string& bytes, std::size_t at) {
  Number value{};
  std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}

/// Image rows in one chunk.
[[nodiscard]] int rows_per_chunk(Imf::Compression compression);
[[nodiscard]] int chunk_count(int height, Imf::Compression compression);

/// Copies one header, its closing 0 included, from `take(to, size)`, which throws when it cannot. An empty result is
/// the end of the headers. Throws std::runtime_error on names or sizes no header has.
[[nodiscard]] std::string take_header(const std::function<void(char*, std::size_t)>& take);
[[nodiscard]] Imf::Header parse_header(const std::string& bytes, int file_version);
[[nodiscard]] std::string serialize(const Imf::Header& header);

/// The pixels of one image as they stand in a single-part file: chunks of (y, size, data), each beginning at starts[i];
/// chunk i holds rows i * rows_per_chunk and on.
struct Chunks {
  std::string bytes;
  std::vector<std::size_t> starts;
};

/// Window, channels, compression and line order: all that the pixels of an image depend on.
[[nodiscard]] Imf::Header layout_header(int width, int height, Imf::PixelType type, Imf::Compression compression);
/// Rows are numbered from y = 0.
[[nodiscard]] Chunks encode(const Image& image, Imf::PixelType type, Imf::Compression compression);
/// Fills image, already of the layout's width and height, from channel Y. Throws what OpenEXR throws.
void decode(const Imf::Header& layout, const Chunks& chunks, Image& image);

/// The only image of a whole file, from channel Y or its only one, row 0 at the top. Throws std::runtime_error, to
/// stand behind the file's name: several channels without Y, sides beyond the limits; what OpenEXR throws.
[[nodiscard]] Image decode_single(const std::string& bytes);

/// Whether a chunk is a row of one channel of floats or halves that decode_rows() knows.
[[nodiscard]] bool has_plain_rows(const Imf::Header& layout);

/// decode() of such an image. Throws std::runtime_error for a row of another size.
void decode_rows(const Imf::Header& layout, const Chunks& chunks, Image& image);

struct Layout {
  Imf::Header header;  // window, channels, compression, line order
  std::string key;     // the same, serialized: parts of equal keys share one Layout
  int width = 0;
  int height = 0;
  int chunks = 0;
  std::size_t max_chunk_bytes = 0;  // OpenEXR stores a chunk uncompressed where compression does not help
};

/// Throws std::runtime_error with what cannot be read: tiles, sizes beyond max_side and max_pixels, subsampled
/// channels, no channel Y, an unknown compression.
[[nodiscard]] Layout checked_layout(const Imf::Header& part);

/// "pixel 3, 4 of image 2 is 1e+30, more than 1e9, ..." of the first value that is not finite, or of projections is no
/// intensity; empty where there is none.
[[nodiscard]] std::string objection(const Image& image, std::size_t index, model::Space space);

}  // namespace vam::io::exr
