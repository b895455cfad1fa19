// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/image/private/matroska.hpp"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <bit>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <vector>

#include "base/error.hpp"

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

namespace {

constexpr std::uint64_t ebml_head = 0x1a45dfa3;
constexpr std::uint64_t segment = 0x18538067;
constexpr std::uint64_t filler = 0xec;  // Void
constexpr std::uint64_t tags = 0x1254c367;
// What a segment consists of: SeekHead, Info, Tracks, Cluster, Cues, Attachments, Chapters, Tags.
constexpr std::array<std::uint64_t, 8> known_parts{0x114d9b74, 0x1549a966, 0x1654ae6b, 0x1f43b675,
                                                   0x1c53bb6b, 0x1941a469, 0x1043a770, tags};
constexpr std::array<char, 2> checksum_head{'\xbf', '\x84'};
constexpr std::uint64_t checksum_bytes = 6;  // head and four bytes

// A number of EBML (RFC 8794 section 4): the leading zeros of the first byte tell how many bytes follow. Its first bit
// belongs to an identifier and not to a size. Empty where it is cut, or "unknown", as in a stream.
std::optional<std::uint64_t> number(std::istream& in, bool identifier) {
  const int first = in.get();
  if (first <= 0) return std::nullopt;
  const int following = std::countl_zero(static_cast<std::uint8_t>(first));
  std::uint64_t value = static_cast<std::uint64_t>(first) & (identifier ? 0xffU : 0x7fU >> following);
  for (int i = 0; i < following; ++i) value = value << 8 | static_cast<std::uint8_t>(in.get());
  const std::uint64_t unknown = (std::uint64_t{1} << (7 * (following + 1))) - 1;
  return in && (identifier || value != unknown) ? std::optional(value) : std::nullopt;
}

std::uint32_t crc32_of(std::istream& in, std::uint64_t size) {
  std::vector<char> buffer(std::size_t{1} << 16);
  uLong sum = crc32(0, nullptr, 0);
  while (size > 0 && in) {
    const auto step = static_cast<std::streamsize>(std::min<std::uint64_t>(size, buffer.size()));
    in.read(buffer.data(), step);
    sum = crc32(sum, reinterpret_cast<const Bytef*>(buffer.data()), static_cast<uInt>(in.gcount()));
    size -= static_cast<std::uint64_t>(step);
  }
  return static_cast<std::uint32_t>(sum);
}

enum class Sum { none, right, wrong };

// Of an element's content, at whose begin the stream stands.
Sum judged(std::istream& in, std::uint64_t size) {
  if (size < checksum_bytes) return Sum::none;
  std::array<char, checksum_bytes> head{};
  in.read(head.data(), checksum_bytes);
  if (!std::equal(checksum_head.begin(), checksum_head.end(), head.begin())) return Sum::none;
  std::uint32_t sealed = 0;
  for (std::size_t i = 0; i < 4; ++i)
    sealed |= static_cast<std::uint32_t>(static_cast<std::uint8_t>(head[2 + i])) << 8 * i;
  return crc32_of(in, size - checksum_bytes) == sealed ? Sum::right : Sum::wrong;
}

// Of the tags at whose content the stream stands.
std::optional<Digest> seal_in(std::istream& in, std::uint64_t size) {
  if (size != seal_element_bytes()) return std::nullopt;
  std::string content(size, '\0');
  in.read(content.data(), static_cast<std::streamsize>(size));
  return parse_seal_element(content);
}

MatroskaProof check_parts(std::istream& in, const std::string& path, std::uint64_t end) {
  MatroskaProof proof;
  std::uint64_t first_bare = 0, first_odd = 0;
  bool& has_sums = proof.checksums;
  while (static_cast<std::uint64_t>(in.tellg()) < end) {
    const auto at = static_cast<std::uint64_t>(in.tellg());
    const auto identifier = number(in, true);
    const auto size = number(in, false);
    const auto content = static_cast<std::uint64_t>(in.tellg());
    const auto refuse = [&](std::uint64_t where) {
      throw Error{Fault::data, path + ": the video is damaged near byte " + std::to_string(where) + "; write it again"};
    };
    if (!identifier || !size || content > end || *size > end - content) {
      if (has_sums) refuse(at);
      return {};  // of unknown size: a stream, which bears no checksums
    }
    if (*identifier != filler) {
      const Sum sum = judged(in, *size);
      if (sum == Sum::wrong) refuse(at);
      has_sums = has_sums || sum == Sum::right;
      if (sum == Sum::none && first_bare == 0) first_bare = at;
      if (std::find(known_parts.begin(), known_parts.end(), *identifier) == known_parts.end() && first_odd == 0)
        first_odd = at;
      for (const std::uint64_t wrong : {first_bare, first_odd}) {
        if (has_sums && wrong > 0) refuse(wrong);
      }
      if (*identifier == tags && sum == Sum::right) {
        in.seekg(static_cast<std::streamoff>(content));
        if (const auto seal = seal_in(in, *size)) proof.seal = seal;
      }
    }
    in.seekg(static_cast<std::streamoff>(content + *size));
  }
  return proof;
}

// Passes the head; false where it is none of Matroska.
bool pass_head(std::istream& in) {
  if (number(in, true) != ebml_head) return false;
  if (const auto head = number(in, false)) in.seekg(static_cast<std::streamoff>(*head), std::ios::cur);
  return true;
}

}  // namespace

std::optional<std::size_t> segment_size_at(const std::string& head) {
  std::istringstream in(head);
  if (!pass_head(in) || number(in, true) != segment) return std::nullopt;
  const auto at = static_cast<std::size_t>(in.tellg());
  return in.peek() == 1 && number(in, false) ? std::optional(at) : std::nullopt;
}

MatroskaProof require_whole_matroska(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  if (!pass_head(in)) return {};
  if (number(in, true) != segment) throw Error{Fault::data, path + ": the video is truncated in its head"};
  const auto size = number(in, false);
  if (!size) return {};
  const std::uint64_t whole = static_cast<std::uint64_t>(in.tellg()) + *size;
  const std::uint64_t there = std::filesystem::file_size(path);
  if (there < whole) {
    throw Error{Fault::data, path + ": the video is truncated: " + std::to_string(there) + " of " +
                                 std::to_string(whole) + " bytes"};
  }
  const MatroskaProof proof = check_parts(in, path, whole);
  if (proof.checksums && there > whole) {
    throw Error{Fault::data,
                path + ": trailing data after the video, from byte " + std::to_string(whole) + " on; write it again"};
  }
  return proof;
}

}  // namespace vam::io
