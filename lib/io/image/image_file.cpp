// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/image/image_file.hpp"

#include <algorithm>
#include <cstdint>

#include "base/error.hpp"
#include "io/image/private/decoders.hpp"
#include "io/stream/apart.hpp"
#include "io/stream/input_name.hpp"
#include "io/stream/stream.hpp"

namespace vam::io {

namespace {

// The largest image, as libtiff and GreyImage have it.
constexpr std::uint64_t most_unpacked = max_pixels * (sizeof(std::uint32_t) + sizeof(std::uint16_t));

bool is_png(const std::string& bytes) { return bytes.starts_with("\x89PNG\r\n\x1a\n"); }

bool is_tiff(const std::string& bytes) {
  using namespace std::string_literals;
  return bytes.starts_with("II*\0"s) || bytes.starts_with("MM\0*"s);
}

void send(const GreyImage& image, Sender& out) {
  out.put(static_cast<std::uint64_t>(image.width));
  out.put(static_cast<std::uint64_t>(image.height));
  out.put(std::uint64_t{image.bits == 16 ? 1U : 0U});
  out.put(image.values.data(), image.values.size() * sizeof image.values[0]);
}

// What a child sends is not believed.
GreyImage received(Receiver& in) {
  const auto width = in.get_count(max_pixels);
  const auto height = in.get_count(max_pixels / std::max<std::uint64_t>(width, 1));
  GreyImage image(static_cast<int>(width), static_cast<int>(height), in.get_count(1) == 1 ? 16 : 8);
  in.get(image.values.data(), image.values.size() * sizeof image.values[0]);
  return image;
}

}  // namespace

GreyImage read_image(const std::string& path) {
  const std::string bytes = read_all(path, Content::binary, std::uint64_t{1} << 30);
  const std::string name = input_name(path);
  if (!is_png(bytes) && !is_tiff(bytes)) throw Error{Fault::data, name + ": neither PNG nor TIFF; convert it first"};
  GreyImage image;
  read_apart(
      {name, bytes.size(), -1, most_unpacked},
      [&](Sender& out) { send(is_png(bytes) ? decode_png(bytes, name) : decode_tiff(bytes, name), out); },
      [&](Receiver& in) { image = received(in); });
  return image;
}

}  // namespace vam::io
