// SPDX-License-Identifier: GPL-3.0-or-later
// Matroska files put together here by RFC 8794: elements of identifier, size and content.
#include "io/image/private/matroska.hpp"

#include <zlib.h>

#include "lib/io/scratch.hpp"
#include "testing.hpp"

using vam::Fault;

namespace {

const std::string cluster("\x1f\x43\xb6\x75"), filler("\xec");
const std::string unknown_size("\x01\xff\xff\xff\xff\xff\xff\xff");

std::string size_of(std::size_t bytes) { return {'\x40', static_cast<char>(bytes)}; }  // in two bytes, up to 255
std::string element(const std::string& identifier, const std::string& content) {
  return identifier + size_of(content.size()) + content;
}

/// A cluster that begins with the CRC-32 of the rest.
std::string summed(const std::string& rest) {
  const auto sum = crc32(0, reinterpret_cast<const Bytef*>(rest.data()), static_cast<uInt>(rest.size()));
  std::string content("\xbf\x84");
  for (int i = 0; i < 4; ++i) content += static_cast<char>(sum >> 8 * i);
  return element(cluster, content + rest);
}

std::string head() { return element("\x1a\x45\xdf\xa3", "matroska") + "\x18\x53\x80\x67"; }
std::string video(const std::string& parts) { return head() + size_of(parts.size()) + parts; }

std::string refusal(const std::string& bytes) {
  const scratch::Folder folder;
  const std::string path = folder.write("a.mkv", bytes);
  const std::string line = error_of([&] { (void)vam::io::require_whole_matroska(path); }, Fault::data);
  return line.starts_with(path) ? line.substr(path.size()) : line;
}

bool has_checksums(const std::string& bytes) {
  const scratch::Folder folder;
  return vam::io::require_whole_matroska(folder.write("a.mkv", bytes)).checksums;
}

std::string damaged_at(std::size_t byte) {
  return ": the video is damaged near byte " + std::to_string(byte) + "; write it again";
}

}  // namespace

TEST_CASE("a Matroska file whose parts have the checksums that they state is accepted, and no other byte of them") {
  const std::string first = summed("one"), second = summed("and another");
  const std::string whole = video(first + element(filler, "room") + second);
  CHECK(refusal(whole) == "no error");
  const std::size_t begin = head().size() + 2;
  for (std::size_t i = 0; i < 4 + 3; ++i) {  // the sum, and what it is of
    std::string other = whole;
    other[begin + 4 + 2 + 2 + i] ^= 1;
    CHECK(refusal(other) == damaged_at(begin));
  }
  std::string other = whole;
  other.back() ^= 1;
  CHECK(refusal(other) == damaged_at(whole.size() - second.size()));
  other = whole;
  other[begin + first.size() + 4] ^= 1;  // in the filler, which nobody reads
  CHECK(refusal(other) == "no error");
}

TEST_CASE("a part that has lost its checksum among parts that have one is damaged, none is asked for elsewhere") {
  const std::string bare = element(cluster, "no checksum"), sealed = summed("one");
  const std::size_t begin = head().size() + 2;
  CHECK(refusal(video(bare + bare)) == "no error");
  CHECK(refusal(video(bare + sealed)) == damaged_at(begin));
  CHECK(refusal(video(sealed + bare)) == damaged_at(begin + sealed.size()));
  for (const std::string& small : {std::string("\xbf\x84"), std::string("\xbf\x84\1\2\3")}) {  // too short for one
    CHECK(refusal(video(element(cluster, small) + bare)) == "no error");
  }
  std::string of_nothing = video(summed(""));
  CHECK(refusal(of_nothing) == "no error");
  of_nothing.back() ^= 1;
  CHECK(refusal(of_nothing) == damaged_at(begin));
}

TEST_CASE("a Matroska stream, whose sizes are unknown, is left to the decoder") {
  const std::string bare = element(cluster, "no checksum");
  for (const std::string& size : {unknown_size, std::string("\xff"), std::string("\x7f\xff")}) {
    CHECK(refusal(head() + size + bare) == "no error");
    CHECK(refusal(video(bare + cluster + size + "open")) == "no error");
    CHECK(refusal(video(summed("one") + cluster + size + "open")) == damaged_at(head().size() + 2 + 4 + 2 + 6 + 3));
  }
}

TEST_CASE("a Matroska file that is cut, or whose parts exceed it, is refused; other files are not its matter") {
  const std::string whole = video(summed("one") + summed("two"));
  CHECK(refusal(whole.substr(0, whole.size() - 1)) == ": the video is truncated: " + std::to_string(whole.size() - 1) +
                                                          " of " + std::to_string(whole.size()) + " bytes");
  CHECK(refusal(head().substr(0, head().size() - 1)) == ": the video is truncated in its head");
  std::string beyond = whole;
  ++beyond[whole.size() - 10];  // the size of the second part
  CHECK(refusal(beyond) == damaged_at(head().size() + 2 + summed("one").size()));
  CHECK(refusal("") == "no error");
  CHECK(refusal("ftypisom") == "no error");
}

TEST_CASE("bytes behind a video whose parts have checksums are refused, and only such a one is said to have them") {
  const std::string bare = video(element(cluster, "no checksum")), sealed = video(summed("one"));
  CHECK(has_checksums(sealed));
  CHECK(refusal(sealed + "x") ==
        ": trailing data after the video, from byte " + std::to_string(sealed.size()) + " on; write it again");
  CHECK_FALSE(has_checksums(bare));
  CHECK(refusal(bare + "x") == "no error");
  CHECK_FALSE(has_checksums(head() + unknown_size + summed("one")));
  CHECK_FALSE(has_checksums("ftypisom"));
}
