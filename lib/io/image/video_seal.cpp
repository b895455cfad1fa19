// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/image/private/video_seal.hpp"

#include <zlib.h>

namespace vam::io {

namespace {

using namespace std::string_literals;

constexpr std::size_t text_bytes = 37;  // of seal_text()
constexpr std::size_t sum_bytes = 6;    // head and four bytes

std::string element(const std::string& identifier, const std::string& content) {
  return identifier + static_cast<char>(0x80U | content.size()) + content;  // a size below 127 in one byte
}

// Tag {Targets {}, SimpleTag {TagName, TagString}}: of the whole file.
std::string tag_of(const std::string& text) {
  const std::string simple = element("\x45\xa3"s, "VAM_SEAL") + element("\x44\x87"s, text);
  return element("\x73\x73"s, element("\x63\xc0"s, "") + element("\x67\xc8"s, simple));
}

}  // namespace

VideoSeal::VideoSeal(int width, int height, int bits, const std::string& version, const std::string& facts) {
  for (const int number : {width, height, bits}) all_.add(static_cast<std::int64_t>(number));
  for (const std::string& text : {version, facts}) {
    if (!text.empty()) all_.add(text);
  }
}

Digest VideoSeal::of(const GreyImage& frame) {
  return digest_of(frame.values.data(), frame.values.size() * sizeof frame.values[0]);
}

void VideoSeal::add(const Digest& frame) {
  all_.add(frame);
  ++frames_;
}

Digest VideoSeal::digest() const { return all_.digest(); }

std::string seal_element(const Digest& digest) {
  const std::string tag = tag_of(seal_text(digest));
  const auto sum = crc32(0, reinterpret_cast<const Bytef*>(tag.data()), static_cast<uInt>(tag.size()));
  std::string content("\xbf\x84");
  for (int shift = 0; shift < 32; shift += 8) content += static_cast<char>(sum >> shift);
  return element("\x12\x54\xc3\x67"s, content + tag);
}

std::size_t seal_element_bytes() { return sum_bytes + tag_of(std::string(text_bytes, '0')).size(); }

std::optional<Digest> parse_seal_element(const std::string& content) {
  if (content.size() != seal_element_bytes()) return std::nullopt;
  const std::string text = content.substr(content.size() - text_bytes);
  Digest digest;
  if (content.substr(sum_bytes) != tag_of(text) || !parse_seal(text, digest)) return std::nullopt;
  return digest;
}

}  // namespace vam::io
