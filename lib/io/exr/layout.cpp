// SPDX-License-Identifier: GPL-3.0-or-later
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfPartType.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <stdexcept>

#include "base/text/text.hpp"
#include "io/exr/private/format.hpp"
#include "io/stream/finite.hpp"

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
  if (!is_size(width, height)) {
    throw std::runtime_error("has an image of " + std::to_string(width) + " x " + std::to_string(height) +
                             " pixels; 1 to 65536 per axis and up to 2^28 in all can be read");
  }
  require_whole(part);
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

namespace {

// Intensities of projections are relative to what cures the resin; a value beyond has another unit, or is damaged, and
// would leave all others dark.
constexpr float most_intensity = 1e9F;

// On the bits, which order positive numbers as their values do, without an early exit: vector code. most: above 0.
bool all_within(const Image& image, float most) {
  bool above = false;
  for (const float value : image.values)
    above |= std::bit_cast<std::int32_t>(value) > std::bit_cast<std::int32_t>(most);
  return !above && all_finite(image.values.data(), image.size());
}

}  // namespace

std::string objection(const Image& image, std::size_t index, model::Space space) {
  constexpr float largest = std::numeric_limits<float>::max();
  const float most = space == model::Space::camera ? largest : most_intensity;
  if (all_within(image, most)) return "";
  const auto is_good = [most](float value) { return value >= -largest && value <= most; };  // NaN is not
  const auto bad = std::find_if_not(image.values.begin(), image.values.end(), is_good);
  const auto at = bad - image.values.begin();
  const std::string pixel = "pixel " + std::to_string(at % image.width) + ", " + std::to_string(at / image.width) +
                            " of image " + std::to_string(index) + " is ";
  if (!std::isfinite(*bad)) return pixel + "not a finite number";
  return pixel + format_number(*bad, 3) + ", but intensities are at most 1e9; check the unit";
}

}  // namespace vam::io::exr
