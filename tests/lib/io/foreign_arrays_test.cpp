// SPDX-License-Identifier: GPL-3.0-or-later
// Volumes of other programs, put together here by their formats' descriptions: NRRD (teem), TIFF 6.0.
#include "io/array/array_file.hpp"
#include "lib/io/array_samples.hpp"
#include "lib/io/scratch.hpp"
#include "lib/io/zip_writer.hpp"
#include "testing.hpp"

using namespace vam;
using namespace vam::io;
using namespace samples;

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
  CHECK(all.shape() == std::array{2, 3, 4});
  REQUIRE(all.values.size() == 24);
  for (std::size_t i = 0; i < 24; ++i) CHECK(all.values[i] == static_cast<float>(i + 1));
  // Every beginning of it is refused, in one line.
  for (const std::size_t cut : {bytes.size() - 1, bytes.size() / 2, std::size_t{40}, std::size_t{5}}) {
    CHECK(!array_refusal(bytes.substr(0, cut)).empty());
  }
}

std::string nrrd(const std::string& fields, const std::string& values) {
  return "NRRD0004\n# of a test\nsizes: 4 3 2\ndimension: 3\nkey:=value\n" + fields + "\n" + values;
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

TEST_CASE("NRRD volumes as they are written") {
  const std::string raw = "encoding: raw\nendian: little\n";
  check_counted(nrrd("type: float\n" + raw, counted<float>()));
  check_counted(nrrd("type: uint8\nencoding: raw\n", counted<std::uint8_t>()));
  check_counted(nrrd("type: float\nspacings: 0.26 6 nan\nunits: \"mm\" \"deg\" \"mm\"\n" + raw, counted<float>()));
}

TEST_CASE("NRRD volumes of other programs are refused with a remedy") {
  const std::string values = counted<float>();
  const std::string plain = "type: float\nencoding: raw\nendian: little\n";
  const auto refused = [&](const std::string& from, const std::string& to) {
    const std::string whole = nrrd(plain, values);
    const std::string said =
        array_refusal(whole.substr(0, whole.find(from)) + to + whole.substr(whole.find(from) + from.size()));
    return said.ends_with("; NRRD is read as vam-view --export writes it: save other volumes as .npy")
               ? said
               : "no remedy: " + said;
  };
  CHECK(has(refused("dimension: 3", "dimension: 99"), "its header has 'dimension: 99';"));
  CHECK(has(refused("encoding: raw", "encoding: gzip"), "its header has 'encoding: gzip';"));
  CHECK(has(refused("endian: little", "endian: big"), "its header has 'endian: big';"));
  CHECK(has(refused("endian: little", "data file: a.raw"), "its header has 'data file: a.raw';"));
  CHECK(has(refused("endian: little", "byte skip: -1"), "its header has 'byte skip: -1';"));
  CHECK(has(refused("endian: little", "nonsense"), "its header has 'nonsense';"));
  CHECK(has(refused("endian: little\n", ""), "its header has no 'endian';"));
  CHECK(has(refused("type: float\n", ""), "its header has no 'type';"));
  CHECK(has(refused("type: float", "type: short"), "has values of type 'short';"));
  CHECK(has(refused("endian: little", "sizes: 2 3 4"), "its header states 'sizes' twice;"));
  CHECK(has(refused("sizes: 4 3 2", "sizes: 4 x 2"), "its header has sizes '4 x 2';"));
  CHECK(has(refused("sizes: 4 3 2", "sizes: 2 4 3 2"), "its header has sizes '2 4 3 2';"));
  CHECK(has(refused("key:=value", "spacings: 1 1 2"), "has voxels '1 1 2', no cubes along x, y and z;"));
  CHECK(has(array_refusal(nrrd(plain, values + "x")), "has bytes behind its 24 values"));
  CHECK(has(array_refusal("NRRD0004\nsizes: -4 3 2\ndimension: 3\n" + plain + "\n"),
            "values; up to 65536 along an axis"));
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
