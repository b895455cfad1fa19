// SPDX-License-Identifier: GPL-3.0-or-later
#include <cstring>
#include <limits>

#include "lib/io/exr_stacks.hpp"
#include "testing.hpp"

using namespace vam;
using namespace vam::io;
using namespace vam::stacks;

TEST_CASE("sizes are checked before memory is taken") {
  const scratch::Folder folder;
  write_stack(folder / "s.exr", sinogram(4, 4, 1));
  std::string bytes = slurp(folder / "s.exr");
  const auto at = bytes.find("dataWindow");
  REQUIRE(at != std::string::npos);
  const std::size_t max_x = at + std::string("dataWindow").size() + 1 + std::string("box2i").size() + 1 + 4 + 8;
  const std::int32_t huge = 2'000'000'000;
  std::memcpy(bytes.data() + max_x, &huge, 4);
  std::memcpy(bytes.data() + max_x + 4, &huge, 4);
  spill(folder / "huge.exr", bytes);
  CHECK(has(error_of([&] { StackReader reader(folder / "huge.exr"); }, Fault::data), "2000000001 x 2000000001"));
}

TEST_CASE("an intensity that no reader takes is not written, and a camera has levels of any size") {
  const scratch::Folder folder;
  Image image(5, 4);
  image(3, 2) = 2e9F;
  auto info = sinogram(5, 4, 1);
  CHECK(has(error_of([&] { StackWriter(folder / "s.exr", info).write(image); }, Fault::data),
            "s.exr: pixel 3, 2 of image 0 is 2e+09, but intensities are at most 1e9"));
  CHECK(folder.count() == 0);
  info.space = model::Space::camera;
  StackWriter writer(folder / "s.exr", info);
  writer.write(image);
  writer.commit();
  model::ImageInfo about;
  Image read;
  CHECK(StackReader(folder / "s.exr").next(read, about));
  CHECK(read(3, 2) == 2e9F);
}

TEST_CASE("a pixel that is not a number is an error with its position") {
  const scratch::Folder folder;
  const float nan = std::numeric_limits<float>::quiet_NaN();
  Image image(5, 4);
  image(3, 2) = nan;
  const auto info = sinogram(5, 4, 2);
  CHECK(status([&] { StackWriter(folder / "s.exr", info).write(image); }) == 70);
  CHECK(folder.count() == 0);

  image(3, 2) = 1234.5F;
  {
    StackWriter writer(folder / "s.exr", info, {false, "none"});
    writer.write(Image(5, 4));
    writer.write(image);
    writer.commit();
  }
  std::string bytes = slurp(folder / "s.exr");
  const float mark = 1234.5F;
  const auto at = bytes.find(std::string(reinterpret_cast<const char*>(&mark), 4));
  REQUIRE(at != std::string::npos);
  std::memcpy(bytes.data() + at, &nan, 4);
  spill(folder / "nan.exr", bytes);
  StackReader reader(folder / "nan.exr");
  model::ImageInfo about;
  CHECK(reader.next(image, about));
  CHECK(has(error_of([&] { reader.next(image, about); }, Fault::data), "pixel 3, 2 of image 1"));
}

TEST_CASE("a stack truncated anywhere is status 65, and a flipped bit never crashes") {
  const scratch::Folder folder;
  const auto info = sinogram(9, 35, 3);
  const auto read = [&](const std::string& bytes) {
    spill(folder / "s.exr", bytes);
    return status([&] {
      StackReader reader(folder / "s.exr");
      Image image;
      model::ImageInfo about;
      while (reader.next(image, about)) CHECK(image.size() == static_cast<std::size_t>(image.width * image.height));
    });
  };
  for (const char* compression : {"none", "rle", "zip", "piz", "pxr24"}) {
    CAPTURE(compression);
    write_stack(folder / "whole.exr", info, {false, compression});
    const std::string whole = slurp(folder / "whole.exr");
    CHECK(read(whole) == 0);
    for (std::size_t length = 0; length < whole.size(); length += 1 + length / 40) {
      CAPTURE(length);
      CHECK(read(whole.substr(0, length)) == 65);
    }
    CHECK(read(whole.substr(0, whole.size() - 1)) == 65);
    unsigned state = 1;
    int refused = 0;
    for (int trial = 0; trial < 400; ++trial) {
      std::string damaged = whole;
      state = state * 1664525U + 1013904223U;
      damaged[(state >> 4) % damaged.size()] ^= static_cast<char>(1U << (state >> 29));
      const int ended = read(damaged);
      CAPTURE(trial);
      CHECK((ended == 0 || ended == 65));  // 0 where the flip made another valid pixel or attribute
      refused += ended == 65 ? 1 : 0;
    }
    CHECK(refused > 20);
  }
}
