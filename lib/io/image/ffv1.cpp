#include "io/image/private/ffv1.hpp"

#include <algorithm>
#include <cstddef>

namespace vam::io {

namespace {

constexpr int slices = 2;                      // across, and down
constexpr std::size_t tail_bytes = 3 + 1 + 4;  // of a slice: its size, its state, its checksum

}  // namespace

Ffv1Frames::Ffv1Frames(int width, int height, Checksum checksum) : width_(width), checksum_(checksum) {
  for (int y = 0; y < slices; ++y) {
    for (int x = 0; x < slices; ++x) {
      Part& part = parts_.emplace_back();
      part.x = width * x / slices;
      part.y = height * y / slices;
      part.width = width * (x + 1) / slices - part.x;
      part.height = height * (y + 1) / slices - part.y;
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
  const Bytes pixels(image.values.begin(), image.values.end());
  std::size_t end = packet.size();
  for (auto part = made.parts_.rbegin(); part != made.parts_.rend(); ++part) {
    if (end < tail_bytes) return std::nullopt;
    const std::uint8_t* tail = packet.data() + end - tail_bytes;
    const std::size_t size = std::size_t{tail[0]} << 16 | std::size_t{tail[1]} << 8 | tail[2];
    const std::size_t codes = made.codes(*part, pixels.data()).size();
    if (size < codes || size + tail_bytes > end) return std::nullopt;
    end -= size + tail_bytes;
    part->head.assign(packet.data() + end, packet.data() + end + (size - codes));
  }
  if (end != 0 || made.packet(pixels.data()) != packet) return std::nullopt;
  return made;
}

Bytes Ffv1Frames::codes(const Part& part, const std::uint8_t* pixels) const {
  Bytes codes;
  append_ffv1_codes(pixels + static_cast<std::ptrdiff_t>(part.y) * width_ + part.x, width_, part.width, part.height,
                    codes);
  return codes;
}

void Ffv1Frames::append(const Part& part, const std::uint8_t* pixels, Bytes& packet) const {
  const std::size_t begin = packet.size();
  packet.insert(packet.end(), part.head.begin(), part.head.end());
  append_ffv1_codes(pixels + static_cast<std::ptrdiff_t>(part.y) * width_ + part.x, width_, part.width, part.height,
                    packet);
  const std::size_t size = packet.size() - begin;
  for (const int shift : {16, 8, 0}) packet.push_back(static_cast<std::uint8_t>(size >> shift));
  packet.push_back(0);
  const std::uint32_t sum = checksum_(packet.data() + begin, packet.size() - begin);
  for (const int shift : {0, 8, 16, 24}) packet.push_back(static_cast<std::uint8_t>(sum >> shift));
}

Bytes Ffv1Frames::packet(const std::uint8_t* pixels) const {
  Bytes packet;
  for (const Part& part : parts_) append(part, pixels, packet);
  return packet;
}

}  // namespace vam::io
