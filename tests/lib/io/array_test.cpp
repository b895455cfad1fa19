// SPDX-License-Identifier: GPL-3.0-or-later
// NumPy arrays, whose bytes are put together here by the format's description (numpy.lib.format).
#include "io/array/private/array.hpp"

#include <limits>

#include "io/array/array_file.hpp"
#include "lib/io/array_samples.hpp"
#include "lib/io/scratch.hpp"
#include "lib/io/zip_writer.hpp"
#include "testing.hpp"

using namespace vam;
using namespace vam::io;
using namespace samples;

namespace {

std::string dictionary(const std::string& type, const std::string& order, const std::string& shape) {
  return "{'descr': '" + type + "', 'fortran_order': " + order + ", 'shape': (" + shape + "), }";
}

std::string array_of(const std::string& head, const std::string& values, int version = 1) {
  const std::string text = head + "\n";
  const std::string length =
      version == 1 ? little(static_cast<std::uint16_t>(text.size())) : little(static_cast<std::uint32_t>(text.size()));
  return "\x93NUMPY" + std::string{static_cast<char>(version), '\0'} + length + text + values;
}

float value(const std::string& type, const std::string& bytes) {
  return read_array(array_of(dictionary(type, "False", "1, 1, 1"), bytes)).values.at(0);
}
std::string head_refusal(const std::string& head) { return array_refusal(array_of(head, std::string(24, '\0'))); }

// 0, 1, 2, ... as bytes.
std::string counted(int count) {
  std::string values;
  for (int i = 0; i < count; ++i) values += static_cast<char>(i);
  return values;
}

}  // namespace

TEST_CASE("values of every type are read as floats") {
  CHECK(value("|b1", "\1") == 1);
  CHECK(value("|b1", "\2") == 1);
  CHECK(value("|b1", std::string(1, '\0')) == 0);
  CHECK(value("|u1", "\xff") == 255);
  CHECK(value("|i1", "\xff") == -1);
  CHECK(value("<u2", "\1\2") == 0x201);
  CHECK(value(">u2", "\1\2") == 0x102);
  CHECK(value("<i2", "\xfe\xff") == -2);
  CHECK(value(">i4", "\xff\xff\xff\xfd") == -3);
  CHECK(value("=u4", little<std::uint32_t>(1 << 31)) == 2147483648.0F);
  CHECK(value("<i8", little<std::int64_t>(-5)) == -5);
  CHECK(value(">u8", big(little<std::uint64_t>(1ULL << 63))) == 0x1p63F);
  CHECK(value("<f4", little(1.25F)) == 1.25F);
  CHECK(value(">f4", big(little(1.25F))) == 1.25F);
  CHECK(value(">f8", big(little(-1.5))) == -1.5F);
  CHECK(value("<f8", little(static_cast<double>(std::numeric_limits<float>::max()))) ==
        std::numeric_limits<float>::max());
}

TEST_CASE("binary16 by its definition: normal, subnormal, signed") {
  const auto half = [](std::uint16_t bits) { return value("<f2", little(bits)); };
  CHECK(half(0x3c00) == 1);
  CHECK(half(0xc001) == -2 * (1 + 1 / 1024.0F));
  CHECK(half(0x7bff) == 65504);
  CHECK(half(0x0400) == 0x1p-14F);
  CHECK(half(0x03ff) == 1023 * 0x1p-24F);
  CHECK(half(0x8001) == -0x1p-24F);
  CHECK(half(0) == 0);
}

TEST_CASE("values that are no finite float are refused, with their place") {
  const std::string three = array_of(dictionary("<f4", "False", "2, 1, 3"), "");
  const std::string five = little(1.0F) + little(2.0F) + little(3.0F) + little(4.0F) + little(5.0F);
  CHECK(has(array_refusal(three + five + little(std::numeric_limits<float>::infinity())),
            "column 2, row 0 of image 1 is not a finite number"));
  CHECK(
      has(array_refusal(array_of(dictionary("<f2", "False", "1, 1"), little<std::uint16_t>(0x7c00))), "not a finite"));
  CHECK(has(array_refusal(array_of(dictionary("<f8", "False", "1, 1"), little(4e38))), "not a finite"));
  CHECK(has(array_refusal(array_of(dictionary("<f8", "False", "1, 1"), little(std::nan("")))), "not a finite"));
}

TEST_CASE("C and Fortran order, axes in any order, planes, and more images than are gathered at a time") {
  for (const bool fortran : {false, true}) {
    CAPTURE(fortran);
    const std::string bytes = array_of(dictionary("|u1", fortran ? "True" : "False", "20, 3, 4"), counted(240));
    for (const std::array<int, 3>& axes : {std::array{0, 1, 2}, {2, 1, 0}, {1, 0, 2}, {0, 2, 1}}) {
      const ReadArray all = read_array(bytes, {"", axes});
      const std::array sizes{20, 3, 4};
      REQUIRE(all.shape() == std::array{sizes[axes[0]], sizes[axes[1]], sizes[axes[2]]});
      std::size_t at = 0;
      for (const auto [image, row, column] : indices(all.size.images, all.size.rows, all.size.columns)) {
        std::array<int, 3> own{};
        own[axes[0]] = image, own[axes[1]] = row, own[axes[2]] = column;
        const int place = fortran ? own[0] + 20 * (own[1] + 3 * own[2]) : (own[0] * 3 + own[1]) * 4 + own[2];
        CHECK(all.values[at++] == static_cast<float>(place));
      }
    }
  }
  const ReadArray plane = read_array(array_of(dictionary("|u1", "False", "3, 4"), counted(12), 3));
  CHECK(plane.shape() == std::array{1, 3, 4});
  CHECK(plane.values[11] == 11);
  // More than are converted at a time.
  const ReadArray wide =
      read_array(array_of(dictionary("|u1", "False", "2, 300, 301"), std::string(180600, '\7') + ""));
  CHECK(wide.values == std::vector<float>(180600, 7.0F));
}

TEST_CASE("the header as other programs write it") {
  CHECK(read_array(array_of("{\"shape\":(1,2,3,),\"fortran_order\":False,\"descr\":\"|u1\"}", counted(6))).values[5] ==
        5);
  CHECK(read_array(array_of("{ 'descr': '<i2', 'fortran_order': True , 'shape': (1L, 2L)}", std::string(4, '\1'), 2))
            .values[1] == 0x101);
}

TEST_CASE("headers that are none, or of what cannot be read, are refused") {
  const char* damaged = "its NumPy header is damaged";
  for (const char* head :
       {"", "x", "{", "{}", "{'descr': '<f4', 'fortran_order': False}", "{'descr': '<f4', 'fortran_order': No, 'shape'",
        "{'descr': '<f4', 'fortran_order': False, 'shape': (2, x), }",
        "{'descr': '<', 'fortran_order': False, 'shape': (1, 1)}",
        "{'descr': '<f4', 'fortran_order': False, 'shape': (1, 1), 'more': 1}", "{'descr: 1",
        "{'descr': '<f4', 'fortran_order': False, 'shape': (1 1)}", "{'descr' '<f4'}"}) {
    CAPTURE(head);
    CHECK(has(head_refusal(head), damaged));
  }
  CHECK(has(head_refusal(dictionary("|O", "False", "1, 1")), "holds Python objects"));
  CHECK(has(head_refusal("{'descr': [('a', '<f4')], 'fortran_order': False, 'shape': (1, 1), }"), "holds records"));
  for (const char* type : {"<c8", "<U4", "<f1", "<i3", "|b2", "<f16", "<u", "<f0"}) {
    CAPTURE(type);
    CHECK(has(head_refusal(dictionary(type, "False", "1, 1")), "has values of type"));
  }
  CHECK(has(head_refusal(dictionary("<f4", "False", "")), "has 0 axes; arrays of 2 or 3 are read"));
  CHECK(has(head_refusal(dictionary("<f4", "False", "5,")), "has 1 axes (5)"));
  CHECK(has(head_refusal(dictionary("<f4", "False", "1, 1, 1, 2")), "has 4 axes (1 x 1 x 1 x 2)"));
  CHECK(has(head_refusal(dictionary("<f4", "False", "3, 0, 2")), "is an empty array (3 x 0 x 2)"));
  CHECK(has(head_refusal(dictionary("<f4", "False", "1, 65537, 1")), "has 1 x 65537 x 1 values; up to 65536"));
  CHECK(has(head_refusal(dictionary("<f4", "False", "1, 99999999999999999999, 1")), "exceed all memory"));
  CHECK(has(head_refusal(dictionary("<f4", "False", "65536, 65536, 257")), "up to 2^40"));
  CHECK(has(head_refusal(dictionary("<f4", "False", "1, 16385, 16384")), "images of more than 2^28 values"));
  CHECK(arrays::parse_npy_head(dictionary("<f4", "False", "65536, 4096, 4096")).values() == arrays::most_values);
}

TEST_CASE("files that are cut, too long or of another kind are refused") {
  const std::string whole = array_of(dictionary("<f4", "False", "2, 1, 2"), std::string(16, '\0'));
  CHECK(read_array(whole).values.size() == 4);
  for (std::size_t size = 1; size < whole.size(); ++size) {
    const std::string line = array_refusal(whole.substr(0, size));
    CHECK(has(line, "is cut off after " + std::to_string(size) + " bytes"));
  }
  CHECK(has(array_refusal(whole + "x"), "has bytes behind its 4 values"));
  CHECK(has(array_refusal(array_of(dictionary("<f4", "True", "2, 1, 2"), std::string(17, '\0'))), "has bytes behind"));
  CHECK(has(array_refusal(""), "is empty"));
  CHECK(has(array_refusal("hello"), "is not an array (NumPy, HDF5, NRRD, TIFF)"));
  for (const int version : {0, 4}) {
    std::string other = whole;
    other[6] = static_cast<char>(version);
    CHECK(has(array_refusal(other), "is not a NumPy array of version 1 to 3"));
  }
  const auto padded = [](std::size_t size) {  // a head of that size with its line feed
    std::string head = dictionary("|u1", "False", "1, 2");
    head.resize(size - 1, ' ');
    return array_of(head, counted(2), 2);
  };
  CHECK(read_array(padded(65536)).values == std::vector<float>{0, 1});
  CHECK(has(array_refusal(padded(65537)), "its NumPy header is damaged"));
}

TEST_CASE("archives: the only array, one of several by name") {
  samples::Zip one;
  one.add("dose.npy", array_of(dictionary("|u1", "False", "1, 2"), counted(2)));
  one.add("notes", "x");
  CHECK(read_array(one.done()).values == std::vector<float>{0, 1});
  samples::Zip two = one;
  two.add("plan/e.npy", array_of(dictionary("|u1", "False", "2, 1"), "\5\6"));
  CHECK(read_array(two.done(), {"plan/e", {0, 1, 2}}).values == std::vector<float>{5, 6});
  CHECK(has(error_of([&] { (void)read_array(two.done()); }, Fault::usage), "holds 2 arrays (dose, plan/e); name one"));
  CHECK(has(error_of([&] { (void)read_array(two.done(), {"plan", {0, 1, 2}}); }, Fault::usage), "none is called plan"));
  samples::Zip cut;  // zeros that pack to almost nothing, and most of them not there
  cut.add_packed("dose.npy", array_of(dictionary("<f4", "False", "1000, 1000, 1000"), std::string(1 << 20, '\0')));
  CHECK(has(array_refusal(cut.done()), "is cut off: its header promises 4000000000 bytes, but the archive has 10486"));
  samples::Zip none;
  none.add("notes", "x");
  CHECK(has(array_refusal(none.done()), "without an array"));
  CHECK(has(array_refusal(one.done().substr(0, one.done().size() - 30)), "truncated or damaged"));
  const std::string whole = one.done();
  for (std::size_t size = 0; size < whole.size(); ++size) CHECK(!array_refusal(whole.substr(0, size)).empty());
  for (const std::string& junk : {std::string("x"), "PK\5\6" + std::string(5, '\0')}) {
    CHECK(has(array_refusal(whole + junk), "trailing data after the end of the .npz archive, from byte " +
                                               std::to_string(whole.size()) + " on; save it again"));
  }
  CHECK(has(array_refusal(whole + whole), "archive begins at byte " + std::to_string(whole.size()) + " only"));
  const std::string comment = "by hand PK\5\6" + std::string(40, '\0');
  const std::string noted =
      whole.substr(0, whole.size() - 2) + little(static_cast<std::uint16_t>(comment.size())) + comment;
  CHECK(read_array(noted).values == std::vector<float>{0, 1});
  two.add("dose.npy", array_of(dictionary("|u1", "False", "1, 2"), counted(2)));
  CHECK(has(array_refusal(two.done(), {"plan/e", {0, 1, 2}}), "holds two files called 'dose.npy', of which only one"));
  std::string flipped = one.done();
  flipped[flipped.find('\1', 60)] = '\3';
  CHECK(has(array_refusal(flipped), "truncated or damaged"));
}

TEST_CASE("what is written is what is read, behind a header of whole lines of 64 bytes") {
  const scratch::Folder folder;
  const std::vector<float> values{0.5F, -1, 2, 3, 4, 1e-30F};
  {
    ArrayWriter writer(folder / "a.npy", {3, 1, 2});
    writer.write(values.data(), 2);
    writer.write(values.data() + 2, 4);
    writer.commit();
  }
  const std::string bytes = scratch::slurp(folder / "a.npy");
  CHECK(read_array(bytes).values == values);
  CHECK(read_array(bytes).size.images == 3);
  CHECK((bytes.size() - 24) % 64 == 0);
  CHECK(bytes.find('\n') == bytes.size() - 25);
  for (const int images : {1, 10, 100, 1000, 10000, 65536}) {  // digits that shift the padding
    CHECK((arrays::head_of_floats({images, 65536, 65536}).size()) % 64 == 0);
    CHECK((arrays::head_of_floats({images, 10, 1}).size()) == 128);
  }
}

TEST_CASE("an array that does not fit on the disk is refused before it is written") {
  const scratch::Folder folder;
  const std::string line = error_of(
      [&] {
        const ArrayWriter writer(folder / "a.npy", {65536, 65536, 65536});
      },
      Fault::io);
  CHECK(has(line, "a.npy: needs 1.05e+06 GiB, but its file system has "));
  CHECK(folder.count() == 0);
}
