// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/image/private/ffv1.hpp"

#include <algorithm>

#include "base/index.hpp"

namespace vam::io {

namespace {

constexpr int slices = 2;                      // across, and down
constexpr std::size_t tail_bytes = 3 + 1 + 4;  // of a slice: its size, its state, its checksum

}  // namespace

Ffv1Frames::Ffv1Frames(int width, int height, Checksum checksum) : checksum_(checksum), parts_(slices * slices) {
  resize(width, height);
}

void Ffv1Frames::resize(int width, int height) {
  for (int y = 0; y < slices; ++y) {
    for (int x = 0; x < slices; ++x) {
      Part& part = parts_[flat_index(y, slices, x)];
      part.place.left = width * x / slices;
      part.place.top = height * y / slices;
      part.place.width = width * (x + 1) / slices - part.place.left;
      part.place.height = height * (y + 1) / slices - part.place.top;
    }
  }
}

GreyImage Ffv1Frames::trial(int width, int height) {
  GreyImage image(width, height, 8);
  std::uint32_t random = 1;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      random = random * 1664525 + 1013904223;
      const auto noise = random >> 24 >> std::min(7, x / 16 % 10);
      image(x, y) = static_cast<std::uint16_t>(y % 16 < 8 ? noise & 0xff : (x + y) * 3 & 0xff);
    }
  }
  return image;
}

std::optional<Ffv1Frames> Ffv1Frames::like(const Bytes& packet, int width, int height, Checksum checksum) {
  if (width < 2 * slices || height < 2 * slices) return std::nullopt;
  Ffv1Frames made(width, height, checksum);
  const GreyImage image = trial(width, height);
  std::size_t end = packet.size();
  for (auto part = made.parts_.rbegin(); part != made.parts_.rend(); ++part) {
    if (end < tail_bytes) return std::nullopt;
    const std::uint8_t* tail = packet.data() + end - tail_bytes;
    const std::size_t size = std::size_t{tail[0]} << 16 | std::size_t{tail[1]} << 8 | tail[2];
    Bytes codes;
    append_ffv1_codes(image, part->place, codes);
    if (size < codes.size() || size + tail_bytes > end) return std::nullopt;
    end -= size + tail_bytes;
    part->head.assign(packet.data() + end, packet.data() + end + (size - codes.size()));
  }
  if (end != 0 || made.packet(image) != packet) return std::nullopt;
  return made;
}

void Ffv1Frames::append(const Part& part, const GreyImage& image, Bytes& packet) const {
  const std::size_t begin = packet.size();
  packet.insert(packet.end(), part.head.begin(), part.head.end());
  append_ffv1_codes(image, part.place, packet);
  const std::size_t size = packet.size() - begin;
  for (const int shift : {16, 8, 0}) packet.push_back(static_cast<std::uint8_t>(size >> shift));
  packet.push_back(0);
  const std::uint32_t sum = checksum_(packet.data() + begin, packet.size() - begin);
  for (const int shift : {0, 8, 16, 24}) packet.push_back(static_cast<std::uint8_t>(sum >> shift));
}

Bytes Ffv1Frames::packet(const GreyImage& image) const {
  Bytes packet;
  for (const Part& part : parts_) append(part, image, packet);
  return packet;
}

}  // namespace vam::io
