// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/image/image_file.hpp"

#include <zlib.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <utility>

#include "lib/io/cpu_time.hpp"
#include "lib/io/scratch.hpp"
#include "testing.hpp"

using vam::GreyImage;
using namespace vam::io;

namespace {

// Every level of the depth, in a width that leaves bits over in the last byte of a row.
GreyImage all_levels(int bits) {
  const int width = 37;
  GreyImage image(width, (1 << bits) / width + 1, bits);
  for (std::size_t i = 0; i < image.values.size(); ++i)
    image.values[i] = static_cast<std::uint16_t>(i & static_cast<std::size_t>(image.full()));
  return image;
}

// A PNG of 8 x 8 grey pixels whose image data are `packed`.
std::string png_of(const std::string& packed) {
  std::string png = encode_png(GreyImage(8, 8, 8)).substr(0, 33);  // signature and IHDR
  for (const std::string& chunk : {"IDAT" + packed, std::string("IEND")}) {
    const auto big_endian = [&](std::size_t value) {
      for (int shift = 24; shift >= 0; shift -= 8) png += static_cast<char>(value >> shift & 0xff);
    };
    big_endian(chunk.size() - 4);
    png += chunk;
    big_endian(crc32(0, reinterpret_cast<const Bytef*>(chunk.data()), static_cast<uInt>(chunk.size())));
  }
  return png;
}

std::string deflated(const std::string& bytes) {
  uLongf size = compressBound(bytes.size());
  std::string packed(size, '\0');
  compress(reinterpret_cast<Bytef*>(packed.data()), &size, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size());
  return packed.substr(0, size);
}

// A TIFF of one strip, by the specification (TIFF 6.0 section 2): little-endian, no compression.
struct TiffOf {
  std::uint32_t width, height, bits, photometric, samples;
  std::uint32_t format = 1;  // whole numbers
  std::uint32_t planes = 1;  // the samples of a pixel side by side
  std::uint32_t orientation = 1;
  [[nodiscard]] std::string with(const std::string& pixels) const {
    const auto put = [](std::uint32_t value, int bytes) {
      std::string text;
      for (int i = 0; i < bytes; ++i) text += static_cast<char>(value >> 8 * i);
      return text;
    };
    const auto size = static_cast<std::uint32_t>(pixels.size());
    const std::array<std::array<std::uint32_t, 2>, 12> tags{{{256, width},
                                                             {257, height},
                                                             {258, bits},
                                                             {259, 1},
                                                             {262, photometric},
                                                             {273, 8},
                                                             {274, orientation},
                                                             {277, samples},
                                                             {278, height},
                                                             {279, size},
                                                             {284, planes},
                                                             {339, format}}};
    std::string bytes = std::string("II*\0", 4) + put(8 + size, 4) + pixels + put(tags.size(), 2);
    for (const auto& [tag, value] : tags) bytes += put(tag, 2) + put(4, 2) + put(1, 4) + put(value, 4);
    return bytes + put(0, 4);
  }
};

}  // namespace

TEST_CASE("PNG of every depth comes back through OpenCV's decoder: level / full of the depth") {
  const scratch::Folder folder;
  for (const int bits : {1, 2, 4, 8, 10, 16}) {
    const GreyImage image = all_levels(bits);
    write_png(folder / "a.png", image);
    const GreyImage back = read_image(folder / "a.png");
    REQUIRE(back.values.size() == image.values.size());
    CHECK(back.bits == (bits > 8 ? 16 : 8));
    int wrong = 0;
    for (std::size_t i = 0; i < image.values.size(); ++i) {
      const int level = image.values[i];
      const int expected = bits == 10 ? level * 64 + level / 16 : level * (back.full() / image.full());
      if (back.values[i] != expected) ++wrong;
      if (bits == 10 && back.values[i] >> 6 != level) ++wrong;
    }
    CHECK(wrong == 0);
  }
}

TEST_CASE("PNG headers state their content: depth, sBIT for 10 bits, text") {
  const std::string png = encode_png(all_levels(2), {{"Software", "vam"}});
  CHECK(png[24] == 2);  // bit depth
  CHECK(png[25] == 0);  // grey
  CHECK(has(png, std::string("tEXtSoftware\0vam", 16)));
  CHECK(has(encode_png(all_levels(10)), "sBIT\x0a"));
  CHECK_FALSE(has(encode_png(all_levels(16)), "sBIT"));
}

TEST_CASE("colours are written unchanged and read as luma") {
  const scratch::Folder folder;
  vam::RgbImage image(3, 1);
  image(0, 0) = {255, 0, 0};
  image(1, 0) = {0, 255, 0};
  image(2, 0) = {80, 80, 80};
  write_png(folder / "c.png", image);
  const GreyImage grey = read_image(folder / "c.png");
  CHECK(std::abs(grey(0, 0) - 76) <= 1);  // BT.601: 0.299 R + 0.587 G + 0.114 B, rounded either way
  CHECK(std::abs(grey(1, 0) - 150) <= 1);
  CHECK(grey(2, 0) == 80);
}

TEST_CASE("truncated, damaged and foreign images are errors") {
  const scratch::Folder folder;
  const std::string png = encode_png(all_levels(8));
  const auto refused = [&](const std::string& bytes) {
    const std::string path = folder.write("bad.png", bytes);
    return error_of([&] { (void)read_image(path); }, vam::Fault::data);
  };
  for (std::size_t size = 8; size < png.size(); size += 5) CHECK(has(refused(png.substr(0, size)), "truncated"));
  std::string flipped = png;
  flipped[png.size() / 2] = static_cast<char>(flipped[png.size() / 2] ^ 1);
  CHECK(has(refused(flipped), "the PNG is damaged"));
  for (const std::string& rest : {std::string("\0", 1), png}) {
    CHECK(has(refused(png + rest), "has " + std::to_string(rest.size()) + " bytes behind the end of its PNG image"));
  }
  CHECK(has(refused("GIF89a"), "neither PNG nor TIFF"));
  CHECK(has(refused(""), "neither PNG nor TIFF"));
  error_of([&] { (void)read_image(folder / "none.png"); }, vam::Fault::no_input);
}

TEST_CASE("what follows the last row of a PNG is refused, and not unpacked") {
  const scratch::Folder folder;
  constexpr std::size_t rows = 8 * 9;
  CHECK(read_image(folder.write("a.png", png_of(deflated(std::string(rows, '\0'))))).values.size() == 64);
  const std::string packed = deflated(std::string(rows, '\0'));
  for (const std::string& bad : {deflated(std::string(rows + 1, '\0')), deflated(std::string(1 << 20, '\0')),
                                 packed + "more", packed.substr(0, packed.size() - 1) + "x"}) {
    const std::string path = folder.write("bad.png", png_of(bad));
    CHECK(has(error_of([&] { (void)read_image(path); }, vam::Fault::data), "bad.png: the PNG is damaged: IDAT"));
  }
  const std::string bomb = png_of(deflated(std::string(std::size_t{200} << 20, '\0')));
  const double before = cpu_s();
  const std::string line = error_of([&] { (void)read_image(folder.write("bomb.png", bomb)); }, vam::Fault::data);
  CHECK(has(line, "IDAT: Too much image data"));
  CHECK(cpu_s() - before < 0.15);  // unpacking it takes 0.4 s
}

TEST_CASE("TIFF of other programs: grey from either end, colours as luma, what is not read") {
  const scratch::Folder folder;
  const auto levels = [&](const TiffOf& tiff, const std::string& pixels) {
    return read_image(folder.write("a.tif", tiff.with(pixels))).values;
  };
  using Levels = std::vector<std::uint16_t>;
  CHECK(levels({2, 1, 8, 1, 1}, "\1\xfe") == Levels{1, 254});
  CHECK(levels({2, 1, 8, 0, 1}, "\1\xfe") == Levels{254, 1});
  CHECK(levels({3, 1, 1, 1, 1}, "\xa0") == Levels{255, 0, 255});
  CHECK(levels({1, 2, 8, 2, 3}, "\xff\xff\xff\xff" + std::string(2, '\0')) == Levels{255, 76});
  CHECK(levels({2, 1, 16, 1, 1}, std::string("\1\0\0\x80", 4)) == Levels{1, 0x8000});
  CHECK(levels({2, 1, 16, 0, 1}, std::string("\1\0\0\x80", 4)) == Levels{65534, 0x7fff});
  CHECK(levels({2, 1, 16, 1, 1, 1, 2}, std::string("\1\0\0\x80", 4)) ==
        Levels{1, 0x8000});                                                             // one sample is its own plane
  CHECK(levels({2, 1, 16, 1, 2}, std::string("\1\0\5\5\3\0\5\5", 8)) == Levels{1, 3});  // and transparency
  // 0.299, 0.587 and 0.114 of full, in 16 bits.
  const std::string full("\xff\xff"), none(2, '\0');
  CHECK(levels({3, 1, 16, 2, 3}, full + none + none + none + full + none + none + none + full) ==
        Levels{19595, 38469, 7471});
  const auto refused = [&](const TiffOf& tiff, std::size_t bytes) {
    const std::string path = folder.write("b.tif", tiff.with(std::string(bytes, '\0')));
    return error_of([&] { (void)read_image(path); }, vam::Fault::data);
  };
  for (const TiffOf& other :
       {TiffOf{1, 1, 16, 2, 1}, {1, 1, 16, 2, 2}, {1, 1, 16, 5, 4}, {1, 1, 16, 1, 1, 2}, {1, 1, 16, 1, 2, 1, 2}})
    CHECK(has(refused(other, std::size_t{2} * other.samples), "16-bit TIFF is read as grey or RGB"));
  CHECK(levels({1, 2, 8, 1, 1, 1, 1, 4}, "\1\2") == Levels{2, 1});  // from the bottom
  CHECK(has(refused({1, 2, 16, 1, 1, 1, 1, 4}, 4), "states that it is turned or mirrored"));
  for (const std::uint32_t exchanged : {5U, 6U, 7U, 8U})
    CHECK(has(refused({1, 2, 8, 1, 1, 1, 1, exchanged}, 2), "states that it is turned or mirrored"));
  const std::string one = TiffOf{1, 1, 8, 1, 1}.with("\5");
  std::string two = one + one.substr(9);
  for (int i = 0; i < 4; ++i) two[one.size() - 4 + i] = static_cast<char>(one.size() >> 8 * i);
  CHECK(has(error_of([&] { (void)read_image(folder.write("c.tif", two)); }, vam::Fault::data),
            "c.tif: holds 2 pages, where one image was expected"));
  CHECK(has(refused({1, 1, 32, 1, 1}, 4), "it has 32 bits a sample"));
  CHECK(has(refused({1, 1, 8, 1, 9}, 9), "it has 9 samples a pixel"));
  CHECK(has(refused({5, 4, 16, 1, 32639}, 40), "it has 32639 samples a pixel"));  // before its rows are taken
  CHECK(has(error_of([&] { (void)read_image(folder.write("d.tif", one.substr(0, one.size() / 2))); }, vam::Fault::data),
            "d.tif: cannot be decoded"));
  CHECK(has(refused({16384, 16385, 8, 1, 1}, 1), "16384 x 16385 pixels; images of up to 2^28"));
  CHECK(has(refused({0, 1, 8, 1, 1}, 1), "truncated or damaged"));
  CHECK(has(refused({1, 0, 8, 1, 1}, 1), "truncated or damaged"));
}

TEST_CASE("a folder is read in numerical order; gaps and differing sizes are errors") {
  const scratch::Folder folder;
  for (int i = 1; i <= 12; ++i) {
    GreyImage image(4, 3, 8);
    image(0, 0) = static_cast<std::uint16_t>(i);
    write_png((folder / "part2_" + std::to_string(i) + ".png"), image);
  }
  ImageFolder images(folder.path.string());
  REQUIRE(images.count() == 12);
  for (int i = 0; i < 12; ++i) CHECK(images.read(i)(0, 0) == i + 1);

  write_png(folder / "part2_13.png", GreyImage(5, 3, 8));
  ImageFolder uneven(folder.path.string());
  (void)uneven.read(0);
  CHECK(has(error_of([&] { (void)uneven.read(12); }, vam::Fault::data), "5 x 3 pixels, but those before have 4 x 3"));

  std::filesystem::remove(folder / "part2_5.png");
  CHECK(has(error_of([&] { ImageFolder{folder.path.string()}; }, vam::Fault::data), "follows number 4"));
  write_png(folder / "other_05.png", GreyImage(4, 3, 8));
  write_png(folder / "part2_5.png", GreyImage(4, 3, 8));
  CHECK(has(error_of([&] { ImageFolder{folder.path.string()}; }, vam::Fault::data), "same number"));
  for (int i = 1; i <= 13; ++i) std::filesystem::remove(folder / ("part2_" + std::to_string(i) + ".png"));
  for (const int number : {0, 10, 20}) write_png(folder / (std::to_string(number) + "mm.PNG"), GreyImage(4, 3, 8));
  std::filesystem::remove(folder / "other_05.png");
  CHECK(ImageFolder(folder.path.string()).count() == 3);
  write_png(folder / "41.png", GreyImage(4, 3, 8));
  CHECK(has(error_of([&] { ImageFolder{folder.path.string()}; }, vam::Fault::data), "10 apart; one is missing"));
  std::filesystem::rename(folder / "41.png", folder / "40.png");
  const ImageFolder gappy(folder.path.string(), true);
  CHECK(gappy.place(0) == 0);
  CHECK(gappy.place(2) == 2);
  CHECK(gappy.place(3) == 4);
  std::filesystem::rename(folder / "40.png", folder / "41.png");
  std::filesystem::rename(folder / "41.png", folder / "30.png");
  write_png(folder / "30_99999999999999999999.png", GreyImage(4, 3, 8));
  CHECK(has(error_of([&] { ImageFolder{folder.path.string()}; }, vam::Fault::data), "is too large"));
  std::filesystem::rename(folder / "30_99999999999999999999.png", folder / "none.tiff");
  CHECK(has(error_of([&] { ImageFolder{folder.path.string()}; }, vam::Fault::data), "the name has no number"));
  error_of([&] { ImageFolder{(folder / "none")}; }, vam::Fault::no_input);
  std::filesystem::create_directory(folder / "empty");
  CHECK(has(error_of([&] { ImageFolder{(folder / "empty")}; }, vam::Fault::data), "no PNG or TIFF"));
}

TEST_CASE("a damaged image in a folder is named, and those beside it are read") {
  const scratch::Folder folder;
  const auto name = [&](int i) { return folder / (std::to_string(i) + ".png"); };
  for (int i = 0; i < 90; ++i) {
    GreyImage image(4, 3, 8);
    image(0, 0) = static_cast<std::uint16_t>(i);
    write_png(name(i), image);
  }
  const std::string whole = scratch::slurp(name(40));
  scratch::spill(name(40), whole.substr(0, whole.size() - 20));
  scratch::spill(name(60), "no image");
  std::filesystem::remove(name(70));
  std::filesystem::create_directory(name(70));
  ImageFolder images(folder.path.string());
  for (int i = 0; i < 90; ++i) {
    if (i == 40 || i == 60 || i == 70) {
      CHECK(has(error_of([&] { (void)images.read(i); }, i == 70 ? vam::Fault::no_input : vam::Fault::data), name(i)));
    } else {
      CHECK(images.read(i)(0, 0) == i);
    }
  }
  for (const int i : {89, 3, 4, 5, 6, 2}) CHECK(images.read(i)(0, 0) == i);
}

TEST_CASE("a PNG that announces more pixels than its bytes can hold is refused before they are") {
  const scratch::Folder folder;
  write_png(folder / "a.png", GreyImage(1, 1, 8));
  std::string bytes = scratch::slurp(folder / "a.png");
  const auto put = [&](std::size_t at, std::uint32_t number) {
    for (int i = 0; i < 4; ++i) bytes[at + static_cast<std::size_t>(i)] = static_cast<char>(number >> (24 - 8 * i));
  };
  put(16, 16384);
  put(20, 16384);
  put(29, static_cast<std::uint32_t>(crc32(0, reinterpret_cast<const Bytef*>(bytes.data()) + 12, 17)));
  scratch::spill(folder / "b.png", bytes);
  CHECK(has(error_of([&] { (void)read_image(folder / "b.png"); }, vam::Fault::data),
            "bytes cannot hold 16384 x 16384 pixels"));
  write_png(folder / "c.png", GreyImage(4096, 4096, 1));  // as small as a file of so many pixels gets
  CHECK(read_image(folder / "c.png").width == 4096);
}
