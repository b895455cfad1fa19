// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/exr/private/layout.hpp"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfPartType.h>

#include <algorithm>
#include <cstdint>
#include <stdexcept>

#include "io/exr/private/format.hpp"

namespace vam::io::exr {

namespace {

std::size_t bytes_per_row(const Imf::Header& header, int width) {
  std::size_t bytes = 0;
  for (auto it = header.channels().begin(); it != header.channels().end(); ++it) {
    bytes += static_cast<std::size_t>(width) * (it.channel().type == Imf::HALF ? 2 : 4);
  }
  return bytes;
}

void check_channels(const Imf::ChannelList& channels) {
  std::string names;
  for (auto it = channels.begin(); it != channels.end(); ++it) {
    names += std::string(" ") + it.name();
    if (it.channel().xSampling != 1 || it.channel().ySampling != 1) throw std::runtime_error("has subsampled channels");
  }
  if (channels.findChannel(channel) != nullptr) return;
  throw std::runtime_error("has no channel Y, but" + (names.empty() ? " none" : names) + "; " +
                           channel_remedy(channels));
}

}  // namespace

Layout checked_layout(const Imf::Header& part) {
  if (part.hasType() && part.type() != Imf::SCANLINEIMAGE) {
    throw std::runtime_error("holds a " + part.type() + "; only scanline images can be read");
  }
  const auto& window = part.dataWindow();
  const std::int64_t width = std::int64_t{window.max.x} - window.min.x + 1;
  const std::int64_t height = std::int64_t{window.max.y} - window.min.y + 1;
  if (width < 1 || height < 1 || width > max_side || height > max_side || width * height > max_pixels) {
    throw std::runtime_error("has an image of " + std::to_string(width) + " x " + std::to_string(height) +
                             " pixels; 1 to 65536 per axis and up to 2^28 in all can be read");
  }
  check_channels(part.channels());
  if (part.compression() < 0 || part.compression() >= Imf::NUM_COMPRESSION_METHODS) {
    throw std::runtime_error("has a compression that is not known");
  }
  Layout layout;
  layout.header = Imf::Header(window, window);
  layout.header.channels() = part.channels();
  layout.header.compression() = part.compression();
  layout.header.lineOrder() = part.lineOrder();
  layout.key = serialize(layout.header);
  layout.width = static_cast<int>(width);
  layout.height = static_cast<int>(height);
  layout.chunks = chunk_count(layout.height, part.compression());
  layout.max_chunk_bytes = bytes_per_row(part, layout.width) *
                           static_cast<std::size_t>(std::min(layout.height, rows_per_chunk(part.compression())));
  return layout;
}

}  // namespace vam::io::exr
