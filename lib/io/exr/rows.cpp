// SPDX-License-Identifier: GPL-3.0-or-later
#include <Imath/half.h>
#include <OpenEXR/ImfChannelList.h>

#include <algorithm>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <string_view>
#include <vector>

#include "io/exr/private/format.hpp"

namespace vam::io::exr {

namespace {

using Bytes = std::span<std::uint8_t>;

[[noreturn]] void refuse(const char* what) { throw std::runtime_error(what); }

// Runs of differences, each to the byte before it and 128 more: a count n from 0 on is of n + 1 that are equal, one
// below 0 of -n that are not.
void undo_runs(std::string_view runs, Bytes to) {
  std::uint8_t last = 128;
  auto out = to.begin();
  const auto room = [&](std::size_t count) {
    if (count > static_cast<std::size_t>(to.end() - out)) refuse("a row of RLE is too long");
    return count;
  };
  for (auto at = runs.begin(); at != runs.end();) {
    const int byte = static_cast<std::uint8_t>(*at++);
    const int n = byte < 128 ? byte : byte - 256;
    if (n < 0) {
      if (runs.end() - at < -n) refuse("a row of RLE ends too early");
      for (const auto end = at + static_cast<std::ptrdiff_t>(room(-n)); at != end; ++at) {
        *out++ = last = static_cast<std::uint8_t>(last + static_cast<std::uint8_t>(*at) - 128);
      }
    } else {
      if (at == runs.end()) refuse("a row of RLE ends too early");
      const auto step = static_cast<std::uint8_t>(static_cast<std::uint8_t>(*at++) - 128);
      const auto end = out + static_cast<std::ptrdiff_t>(room(n + 1));
      if (step == 0) {
        out = std::fill_n(out, n + 1, last);
      } else {
        while (out != end) *out++ = last = static_cast<std::uint8_t>(last + step);
      }
    }
  }
  if (out != to.end()) refuse("a row of RLE is too short");
}

// The bytes at even places came first, then those at odd ones.
void interleave(const std::uint8_t* even, std::size_t count, std::uint8_t* to) {
  const std::uint8_t* odd = even + (count + 1) / 2;
  for (std::size_t i = 0; i < count / 2; ++i) {
    to[2 * i] = even[i];
    to[2 * i + 1] = odd[i];
  }
  if (count % 2 != 0) to[count - 1] = even[count / 2];
}

// The bytes of a row from its chunk; a chunk as long as the row holds it as it is.
class RowDecoder {
 public:
  RowDecoder(bool rle, std::size_t row_bytes) : rle_(rle), apart_(rle ? row_bytes : 0) {}

  void decode(std::string_view chunk, Bytes row) {
    if (chunk.size() == row.size()) {
      std::memcpy(row.data(), chunk.data(), row.size());
    } else if (rle_) {
      undo_runs(chunk, apart_);
      interleave(apart_.data(), row.size(), row.data());
    } else {
      refuse("an uncompressed row has the wrong size");
    }
  }

 private:
  bool rle_;
  std::vector<std::uint8_t> apart_;
};

std::string_view chunk_of_row(const Chunks& chunks, int y) {
  const std::size_t start = chunks.starts[static_cast<std::size_t>(y)];
  const auto size = static_cast<std::size_t>(number_at<std::int32_t>(chunks.bytes, start + 4));
  return std::string_view(chunks.bytes).substr(start + 8, size);
}

template <class Pixel>
void decode_pixels(bool rle, const Chunks& chunks, Image& image) {
  std::vector<Pixel> pixels(static_cast<std::size_t>(image.width));
  const Bytes row(reinterpret_cast<std::uint8_t*>(pixels.data()), pixels.size() * sizeof(Pixel));
  RowDecoder decoder(rle, row.size());
  for (int y = 0; y < image.height; ++y) {
    const std::string_view chunk = chunk_of_row(chunks, y);
    if (y > 0 && chunk == chunk_of_row(chunks, y - 1)) {  // dark rows are all the same
      std::copy_n(image.row(y - 1), image.width, image.row(y));
    } else {
      decoder.decode(chunk, row);
      std::copy(pixels.begin(), pixels.end(), image.row(y));
    }
  }
}

}  // namespace

bool has_plain_rows(const Imf::Header& layout) {
  auto second = layout.channels().begin();
  return (layout.compression() == Imf::NO_COMPRESSION || layout.compression() == Imf::RLE_COMPRESSION) &&
         (second++).channel().type != Imf::UINT && second == layout.channels().end();
}

void decode_rows(const Imf::Header& layout, const Chunks& chunks, Image& image) {
  const bool rle = layout.compression() == Imf::RLE_COMPRESSION;
  if (layout.channels().begin().channel().type == Imf::HALF) {
    decode_pixels<half>(rle, chunks, image);
  } else {
    decode_pixels<float>(rle, chunks, image);
  }
}

}  // namespace vam::io::exr
