// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/image/private/matroska.hpp"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <optional>
#include <sstream>
#include <vector>

#include "base/error.hpp"
#include "io/image/private/video_seal.hpp"

namespace vam::io {

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
