// SPDX-License-Identifier: GPL-3.0-or-later
// Volumes of other programs, put together here by their formats' descriptions: NRRD (teem), MRC2014, TIFF 6.0.
#include <zlib.h>

#include "io/array/array_reader.hpp"
#include "lib/io/array_samples.hpp"
#include "lib/io/scratch.hpp"
#include "lib/io/zip_writer.hpp"
#include "testing.hpp"

using namespace vam;
using namespace vam::io;
using samples::array_refusal;
using samples::big;
using samples::little;
using samples::read_array;
using samples::ReadArray;

namespace {

// 1, 2, ... of 2 slices of 3 rows of 4 columns.
template <class Value>
std::string counted(bool big_endian = false) {
  std::string bytes;
  for (int i = 1; i <= 24; ++i) {
    const std::string one = little(static_cast<Value>(i));
    bytes += big_endian ? big(one) : one;
  }
  return bytes;
}
void check_counted(const std::string& bytes) {
  const ReadArray all = read_array(bytes);
  CHECK(all.size.images == 2);
  CHECK(all.size.rows == 3);
  CHECK(all.size.columns == 4);
  REQUIRE(all.values.size() == 24);
  for (std::size_t i = 0; i < 24; ++i) CHECK(all.values[i] == static_cast<float>(i + 1));
  // Every beginning of it is refused, in one line.
  for (const std::size_t cut : {bytes.size() - 1, bytes.size() / 2, std::size_t{40}, std::size_t{5}}) {
    CHECK(!array_refusal(bytes.substr(0, cut)).empty());
  }
}

std::string gzipped(const std::string& bytes) {
  std::string packed(bytes.size() + 1000, '\0');
  z_stream state{};
  REQUIRE(deflateInit2(&state, 9, Z_DEFLATED, 16 + MAX_WBITS, 8, Z_DEFAULT_STRATEGY) == Z_OK);
  std::string from = bytes;
  state.next_in = reinterpret_cast<Bytef*>(from.data());
  state.avail_in = static_cast<uInt>(from.size());
  state.next_out = reinterpret_cast<Bytef*>(packed.data());
  state.avail_out = static_cast<uInt>(packed.size());
  REQUIRE(deflate(&state, Z_FINISH) == Z_STREAM_END);
  packed.resize(state.total_out);
  deflateEnd(&state);
  return packed;
}

std::string nrrd(const std::string& fields, const std::string& values) {
  return "NRRD0004\n# of a test\nsizes: 4 3 2\ndimension: 3\nkey:=value\n" + fields + "\n" + values;
}

std::string mrc(std::int32_t mode, const std::string& values, std::int32_t extended = 0, bool big_endian = false,
                std::int32_t slowest = 3) {
  std::vector<std::int32_t> words(256, 0);
  words[0] = 4, words[1] = 3, words[2] = 2, words[3] = mode;
  words[16] = 1, words[17] = 2, words[18] = slowest;
  words[23] = extended;
  std::string head;
  for (const std::int32_t word : words) head += big_endian ? big(little(word)) : little(word);
  head.replace(208, 4, "MAP ");
  head.replace(212, 2, big_endian ? "\x11\x11" : "\x44\x44");
  return head + std::string(static_cast<std::size_t>(std::max(extended, 0)), 'x') + values;
}

// One strip a page; the pages' values begin at byte 8, page after page, their lists follow them.
std::string tiff(std::uint16_t bits, std::uint16_t format, const std::string& values, bool big_endian = false,
                 std::uint16_t photometric = 1, std::uint32_t second_width = 4, std::uint16_t orientation = 1) {
  const auto number = [&](auto value) { return big_endian ? big(little(value)) : little(value); };
  const auto page = static_cast<std::uint32_t>(values.size() / 2);
  const auto lists = static_cast<std::uint32_t>(8 + values.size());
  const std::uint32_t list_bytes = 2 + 10 * 12 + 4;
  std::string bytes =
      (big_endian ? std::string("MM") : std::string("II")) + number(std::uint16_t{42}) + number(lists) + values;
  for (std::uint32_t p = 0; p < 2; ++p) {
    const auto entry = [&](std::uint16_t tag, std::uint32_t value, bool wide) {
      bytes += number(tag) + number(static_cast<std::uint16_t>(wide ? 4 : 3)) + number(std::uint32_t{1});
      bytes += wide ? number(value) : number(static_cast<std::uint16_t>(value)) + std::string(2, '\0');
    };
    bytes += number(std::uint16_t{10});
    entry(256, p == 0 ? 4 : second_width, true);
    entry(257, 3, true);
    entry(258, bits, false);
    entry(259, 1, false);
    entry(262, photometric, false);
    entry(273, 8 + p * page, true);
    entry(274, orientation, false);
    entry(278, 3, true);
    entry(279, page, true);
    entry(339, format, false);
    bytes += number(p == 0 ? lists + list_bytes : std::uint32_t{0});
  }
  return bytes;
}

}  // namespace

TEST_CASE("NRRD volumes of every type, byte order and packing") {
  const std::string raw = "encoding: raw\nendian: little\n";
  check_counted(nrrd("type: float\n" + raw, counted<float>()));
  check_counted(nrrd("type: double\n" + raw, counted<double>()));
  check_counted(nrrd("type: uchar\nencoding: raw\n", counted<std::uint8_t>()));
  check_counted(nrrd("type: unsigned short\n" + raw, counted<std::uint16_t>()));
  check_counted(nrrd("type: int64\n" + raw, counted<std::int64_t>()));
  check_counted(nrrd("type: short\nencoding: raw\nendian: big\n", counted<std::int16_t>(true)));
  check_counted(nrrd("type: float\nencoding: gzip\nendian: little\n", gzipped(counted<float>())));
}

TEST_CASE("NRRD files that are not read are refused with a remedy") {
  std::string other = nrrd("type: float\nencoding: raw\nendian: little\n", counted<float>());
  other.replace(other.find("dimension: 3"), 12, "dimension: 99");
  CHECK(has(array_refusal(other), "its header is damaged: dimension '99', but 3 sizes"));
  const std::string raw = "encoding: raw\nendian: little\n";
  CHECK(has(array_refusal(nrrd("type: float\nencoding: ascii\nendian: little\n", "1 2 3")),
            "raw and gzip are read; write it"));
  CHECK(has(array_refusal(nrrd("type: float\ndata file: a.raw\n" + raw, "")), "in another file"));
  CHECK(has(array_refusal(nrrd("type: float\nbyte skip: -1\n" + raw, counted<float>())), "skips bytes"));
  CHECK(has(array_refusal(nrrd("type: block\n" + raw, "")), "'block'"));
  CHECK(has(array_refusal(nrrd(raw, counted<float>())), "has no 'type'"));
  CHECK(has(array_refusal(nrrd("type: float\nencoding: raw\n", counted<float>())), "has no 'endian'"));
  CHECK(has(array_refusal(nrrd("type: float\n" + raw, counted<float>() + "x")), "has bytes behind its 24 values"));
  CHECK(has(array_refusal(nrrd("type: float\nsizes: 2 3 4\n" + raw, counted<float>())),
            "its header states 'sizes' twice, of which only one would count"));
  CHECK(has(array_refusal(nrrd("nonsense\n" + raw, counted<float>())), "'nonsense' is no field"));
  CHECK(has(array_refusal("NRRD0004\ntype: float\nsizes: 4 x 2\n" + raw + "\n"), "sizes '4 x 2'"));
  CHECK(has(array_refusal("NRRD0004\ntype: float\nsizes: 2 4 3 2\n" + raw + "\n"), "has 4 axes (2 x 3 x 4 x 2)"));
  const std::string packed = nrrd("type: float\nencoding: gzip\nendian: little\n", gzipped(counted<float>()));
  std::string damaged = packed;
  damaged[damaged.size() - 20] = static_cast<char>(damaged[damaged.size() - 20] ^ 0x55);
  CHECK(!array_refusal(damaged).empty());
}

TEST_CASE("NRRD: members of gzip are read one behind the other, up to the end of the file and its checksums") {
  const auto packed = [](const std::string& data) {
    return nrrd("type: float\nencoding: gzip\nendian: little\n", data);
  };
  const std::string values = counted<float>();
  const std::string whole = gzipped(values);
  for (const std::size_t first : {std::size_t{0}, std::size_t{1}, std::size_t{50}, values.size()}) {
    CAPTURE(first);
    check_counted(packed(gzipped(values.substr(0, first)) + gzipped(values.substr(first))));
  }
  for (std::size_t left = 1; left <= 8; ++left) {
    CHECK(
        has(array_refusal(packed(whole.substr(0, whole.size() - left))), "is cut off before the end of its gzip data"));
    std::string damaged = whole;
    damaged[whole.size() - left] = static_cast<char>(damaged[whole.size() - left] ^ 1);
    CHECK(has(array_refusal(packed(damaged)), "its gzip data is damaged"));
  }
  CHECK(has(array_refusal(packed(whole + "junk")), "has bytes behind its gzip data; it is damaged"));
  CHECK(has(array_refusal(packed(whole + '\0')), "has bytes behind its gzip data; it is damaged"));
  CHECK(has(array_refusal(packed(whole + "\x1f")), "is cut off before the end of its gzip data"));
  CHECK(has(array_refusal(packed(whole + whole)), "has bytes behind its 24 values"));
  CHECK(has(array_refusal(packed(gzipped(values.substr(0, 50)))), "is cut off after"));
}

TEST_CASE("MRC volumes of the modes that are numbers, with and without an extended header") {
  check_counted(mrc(2, counted<float>()));
  check_counted(mrc(2, counted<float>(), 512));
  check_counted(mrc(0, counted<std::int8_t>()));
  check_counted(mrc(1, counted<std::int16_t>()));
  check_counted(mrc(6, counted<std::uint16_t>()));
  check_counted(mrc(1, counted<std::int16_t>(true), 0, true));
  CHECK(has(array_refusal(mrc(4, counted<double>())), "MRC mode 4"));
  CHECK(has(array_refusal(mrc(2, counted<float>(), 0, false, 2)), "axes in another order"));
  CHECK(has(array_refusal(mrc(2, counted<float>(), -5)), "header is damaged"));
  std::string negative = mrc(2, counted<float>());
  negative.replace(0, 4, "\xfc\xff\xff\xff");
  CHECK(has(array_refusal(negative), "its header is damaged: -4 values along an axis"));
}

TEST_CASE("TIFF files of several pages, whole numbers and floats") {
  check_counted(tiff(32, 3, counted<float>()));
  check_counted(tiff(64, 3, counted<double>()));
  check_counted(tiff(8, 1, counted<std::uint8_t>()));
  check_counted(tiff(16, 1, counted<std::uint16_t>()));
  check_counted(tiff(32, 2, counted<std::int32_t>()));
  check_counted(tiff(16, 1, counted<std::uint16_t>(true), true));
  check_counted(tiff(32, 3, counted<float>(true), true));
  CHECK(has(array_refusal(tiff(16, 1, counted<std::uint16_t>(), false, 0)), "page 0 is not grey in strips"));
  CHECK(has(array_refusal(tiff(16, 1, counted<std::uint16_t>(), false, 1, 3)), "page 1 differs from page 0"));
  CHECK(has(array_refusal(tiff(16, 1, counted<std::uint16_t>(), false, 1, 4, 4)), "page 0 states that it is turned"));
  CHECK(has(array_refusal(tiff(12, 1, counted<std::uint16_t>())), "12 bits"));
  // Cut anywhere in the list of the second page, which the first one's names.
  const std::string whole = tiff(8, 1, counted<std::uint8_t>());
  for (std::size_t lost = 1; lost <= 114; ++lost)
    CHECK(has(array_refusal(whole.substr(0, whole.size() - lost)), "cut off"));
  CHECK(has(array_refusal(tiff(32, 6, counted<double>())), "sample format 6"));
}
