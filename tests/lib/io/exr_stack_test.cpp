// SPDX-License-Identifier: GPL-3.0-or-later
#include <OpenEXR/ImfDoubleAttribute.h>
#include <OpenEXR/ImfIntAttribute.h>
#include <OpenEXR/ImfPartType.h>
#include <OpenEXR/ImfStringAttribute.h>

#include <thread>

#include "io/exr/stack.hpp"
#include "lib/io/exr_stacks.hpp"
#include "testing.hpp"

using namespace vam;
using namespace vam::io;
using namespace vam::stacks;

TEST_CASE("facts and pixels survive a file, for every compression and both widths") {
  const scratch::Folder folder;
  const auto info = sinogram(37, 70, 20);  // 70 rows: not a multiple of any compressor's block
  for (const char* compression : {"none", "rle", "zip", "zips", "piz"}) {
    for (const bool narrow : {false, true}) {
      CAPTURE(compression);
      CAPTURE(narrow);
      write_stack(folder / "s.exr", info, {narrow, compression});
      StackReader reader(folder / "s.exr");
      CHECK(reader.info().kind == model::Kind::sinogram);
      CHECK(reader.info().space == model::Space::virtual_);
      CHECK(reader.info().width == 37);
      CHECK(reader.info().height == 70);
      CHECK(reader.info().count == 20);
      CHECK(reader.info().pixel_mm == 0.1);
      CHECK(reader.info().row_mm == 0.1);
      CHECK(reader.info().z_start_mm == -3);
      CHECK(reader.info().angle_step_deg == 1);
      CHECK(reader.info().units == info.units);
      auto history = info.history;
      history.push_back("# sealed " + reader.seal());
      CHECK(reader.info().history == history);
      CHECK(reader.info().extra == info.extra);
      Image image;
      model::ImageInfo about;
      for (int i = 0; i < 20; ++i) {
        REQUIRE(reader.next(image, about));
        CHECK(about.z_mm == doctest::Approx(-3 + 0.1 * i));
        CHECK_FALSE(about.has_angle);
        const Image wanted = pattern(37, 70, i);
        // A half has 11 significant bits: rounding to the nearest errs by at most 2^-11 of the value.
        double worst = 0;
        for (std::size_t p = 0; p < wanted.size(); ++p) {
          const double error = std::abs(double{image.values[p]} - double{wanted.values[p]});
          worst = std::max(worst, error - std::ldexp(double{wanted.values[p]}, -11));
        }
        if (narrow) CHECK(worst <= 0);
        if (!narrow) CHECK(image.values == wanted.values);
        // What OpenEXR reads is the same, bit for bit.
        if (i % 7 == 0) CHECK(read_by_openexr(folder / "s.exr", i).values == image.values);
      }
      CHECK_FALSE(reader.next(image, about));
      CHECK_FALSE(reader.next_stack());
    }
  }
}

TEST_CASE("headers are those of a standard file") {
  const scratch::Folder folder;
  write_stack(folder / "s.exr", sinogram(5, 6, 3));
  Imf::MultiPartInputFile file((folder / "s.exr").c_str(), 0, false);
  REQUIRE(file.parts() == 3);
  CHECK(file.header(2).name() == "z0002");
  CHECK(file.header(2).type() == Imf::SCANLINEIMAGE);
  CHECK(file.header(2).findTypedAttribute<Imf::IntAttribute>("vam:index")->value() == 2);
  CHECK(file.header(2).findTypedAttribute<Imf::DoubleAttribute>("vam:z_mm")->value() == doctest::Approx(-2.8));
  CHECK(file.header(2).findTypedAttribute<Imf::StringAttribute>("vam:history")->value() ==
        "vam-slice 0.1.0 part.stl\nvam-sinogram 0.1.0");
}

TEST_CASE("a pipe carries the bytes of a valid, complete file") {
  const scratch::Folder folder;
  const auto info = sinogram(33, 12, 5);
  for (const bool narrow : {false, true}) {
    {
      const scratch::Redirect to(STDOUT_FILENO, folder / "piped.exr");
      write_stack("-", info, {narrow, "zip"});
    }
    write_stack(folder / "file.exr", info, {narrow, "none"});
    // The same but for the seals: 7 letters in each header instead of 37, and the trailer.
    const auto size = slurp(folder / "file.exr").size();
    CHECK(slurp(folder / "piped.exr").size() == size - std::size_t{5 * 30} + 8 + std::size_t{6 * 16});
    for (int i = 0; i < 5; ++i) {
      const Image read = read_by_openexr(folder / "piped.exr", i);
      if (!narrow) CHECK(read.values == pattern(33, 12, i).values);
    }
  }
}

TEST_CASE("facts that come behind the images are in a pipe, too, or refused") {
  const scratch::Folder folder;
  auto info = sinogram(33, 12, 1);
  info.extra["vam:threshold_dose"] = "unknown";
  for (const bool late : {true, false}) {
    CAPTURE(late);
    const scratch::Redirect to(STDOUT_FILENO, folder / "piped.exr");
    StackWriter writer("-", info, StackOptions{.late = late});
    writer.write(pattern(33, 12, 0));
    const auto state = [&] { writer.state({{"vam:threshold_dose", "3 turns"}}); };
    if (!late) {
      CHECK(fault_of(state) == Fault::bug);
      continue;
    }
    state();
    writer.commit();
    CHECK(StackReader(folder / "piped.exr").info().extra.at("vam:threshold_dose") == "3 turns");
  }
}

TEST_CASE("a compressed file can be read from a pipe") {
  const scratch::Folder folder;
  const auto info = sinogram(33, 40, 40);
  write_stack(folder / "file.exr", info, {false, "piz"});
  const Fifo fifo(folder / "pipe");
  std::thread cat([&] { spill(fifo.path, slurp(folder / "file.exr")); });
  StackReader reader(fifo.path);
  Image image;
  model::ImageInfo about;
  int count = 0;
  while (reader.next(image, about)) CHECK(image.values == pattern(33, 40, count++).values);
  CHECK(count == 40);
  cat.join();
}

TEST_CASE("measured angles and times: known before, or only with the image; in a file and through a pipe") {
  const scratch::Folder folder;
  auto info = sinogram(4, 3, 6);
  info.kind = model::Kind::frames;
  info.space = model::Space::camera;
  std::vector<model::ImageInfo> facts(6);
  for (int i = 0; i < 6; ++i) {
    facts[i].z_mm = 1.5;
    facts[i].angle_deg = 60.0 * i + 0.01 * i * i;
    facts[i].time_s = 0.1 * i;
    facts[i].time_sigma_s = i % 3 * 1e-4;  // not known of every frame
    facts[i].has_angle = facts[i].has_time = true;
  }
  const auto write = [&](const std::string& path, bool known) {
    StackWriter writer = known ? StackWriter(path, info, facts) : StackWriter(path, info);
    for (int i = 0; i < 6; ++i) writer.write(pattern(4, 3, i), facts[i]);
    writer.commit();
  };
  for (const bool known : {true, false}) {
    for (const bool piped : {true, false}) {
      CAPTURE(known);
      CAPTURE(piped);
      if (piped) {
        const scratch::Redirect to(STDOUT_FILENO, folder / "a.exr");
        write("-", known);
      } else {
        write(folder / "a.exr", known);
      }
      StackReader reader(folder / "a.exr");
      REQUIRE(reader.about().size() == 6);
      Image image;
      model::ImageInfo about;
      for (int i = 0; reader.next(image, about); ++i) {
        const auto& wanted = facts[i];
        CHECK(about.has_angle);
        CHECK(about.has_time);
        CHECK(about.angle_deg == wanted.angle_deg);
        CHECK(about.time_s == wanted.time_s);
        CHECK(about.time_sigma_s == wanted.time_sigma_s);
        CHECK(about.z_mm == 1.5);
        CHECK(reader.about()[i].angle_deg == wanted.angle_deg);
        CHECK(image.values == pattern(4, 3, i).values);
      }
      CHECK(read_by_openexr(folder / "a.exr", 5).values == pattern(4, 3, 5).values);
    }
  }
}

TEST_CASE("several stacks on one stream follow each other") {
  const scratch::Folder folder;
  write_stack(folder / "one.exr", sinogram(8, 4, 3));
  write_stack(folder / "two.exr", sinogram(8, 5, 2), {false, "none"});
  spill(folder / "both.exr", slurp(folder / "one.exr") + slurp(folder / "two.exr"));
  StackReader reader(folder / "both.exr", true);
  Image image;
  model::ImageInfo about;
  CHECK(reader.info().count == 3);
  CHECK(status([&] { reader.next_stack(); }) == 70);  // images are left
  for (int i = 0; i < 3; ++i) CHECK(reader.next(image, about));
  CHECK_FALSE(reader.next(image, about));
  REQUIRE(reader.next_stack());
  CHECK(reader.info().height == 5);
  for (int i = 0; i < 2; ++i) REQUIRE(reader.next(image, about));
  CHECK(image.values == pattern(8, 5, 1).values);
  CHECK_FALSE(reader.next_stack());
  StackReader single(folder / "both.exr");  // what follows would be ignored
  CHECK(status([&] {
          while (single.next(image, about)) continue;
        }) == 65);
}

TEST_CASE("part names grow with the number of parts, so that they sort") {
  const scratch::Folder folder;
  write_stack(folder / "s.exr", sinogram(1, 1, 10'001));
  Imf::MultiPartInputFile file((folder / "s.exr").c_str(), 0, false);
  CHECK(file.header(0).name() == "z00000");
  CHECK(file.header(10'000).name() == "z10000");
}

TEST_CASE("half is an error where it cannot represent a value") {
  const scratch::Folder folder;
  CHECK(status([&] {
          StackWriter(folder / "s.exr", sinogram(5, 4, 1), {true, "rle"}).write(Image(5, 4, 70000));
        }) == 65);
  CHECK(folder.count() == 0);
}

TEST_CASE("the announced number and size of images are enforced") {
  const scratch::Folder folder;
  const auto info = sinogram(5, 4, 2);
  CHECK(status([&] {
          StackWriter writer(folder / "s.exr", info);
          writer.write(Image(5, 4));
          writer.commit();
        }) == 70);
  CHECK(status([&] { StackWriter(folder / "s.exr", info).write(Image(4, 5)); }) == 70);
  CHECK(status([&] { StackWriter(folder / "s.exr", info, {false, "dwaa"}); }) == 64);
  CHECK(status([&] { write_stack("/dev/full", info); }) == 74);
  CHECK(folder.count() == 0);
}

TEST_CASE("the wrong kind or space is an error that names it") {
  auto info = sinogram(4, 4, 4);
  CHECK(status([&] { require("a.exr", info, model::Kind::sinogram, model::Space::virtual_); }) == 0);
  CHECK(status([&] { require("a.exr", info, model::Kind::sinogram); }) == 0);
  CHECK(error_of([&] { require("a.exr", info, model::Kind::frames, model::Space::projector); }, Fault::data) ==
        "a.exr: holds sinogram (virtual), but frames (projector) is needed");
  CHECK(error_of([&] { require("a.exr", info, model::Kind::sinogram, model::Space::projector); }, Fault::data) ==
        "a.exr: holds sinogram (virtual), but sinogram (projector) is needed; convert it by vam-resample");
  CHECK(error_of([&] { require("-", info, model::Kind::frames); }, Fault::data) ==
        "stdin: holds sinogram (virtual), but frames is needed");
}

TEST_CASE("poses travel in the first header, one a row") {
  const scratch::Folder folder;
  auto info = sinogram(4, 3, 2);
  info.poses = {
      {0, 0.1, 0, 0, model::Moves::vial}, {1, 0, 0.1, 0, model::Moves::vial}, {2, 0, 0, -2, model::Moves::part}};
  write_stack(folder / "s.exr", info, {});
  StackReader reader(folder / "s.exr");
  CHECK(reader.info().poses == info.poses);
  CHECK(reader.info().extra == info.extra);
  info.poses.pop_back();
  write_stack(folder / "short.exr", info, {});
  CHECK(status([&] { StackReader{folder / "short.exr"}; }) == 65);
}

// OpenEXR's writer makes the file, so that nothing of ours knows its runs.
TEST_CASE("rows of RLE: dark, equal, even, steps and noise, of any width, as OpenEXR reads them") {
  const scratch::Folder folder;
  for (const int width : {1, 2, 3, 127, 129, 300}) {
    for (const bool narrow : {false, true}) {
      CAPTURE(width);
      const auto info = sinogram(width, 14, 2);
      const auto pixel = [&](int x, int y, unsigned noise) -> float {
        if (y < 4) return 0;
        if (y < 6) return x < width / 3 || x > width / 2 ? 0.0F : 0.25F;
        if (y < 8) return 7;
        if (y < 10) return static_cast<float>(x);
        return static_cast<float>(noise >> 20) / 4096.0F;
      };
      unsigned state = 1;
      Image image(width, info.height);
      for (const auto [y, x] : indices(image.height, width))
        image(x, y) = pixel(x, y, state = state * 1664525U + 1013904223U);
      StackWriter writer(folder / "s.exr", info, {narrow, "rle"});
      writer.write(image);
      writer.write(Image(width, info.height));
      writer.commit();
      StackReader reader(folder / "s.exr");
      Image read;
      model::ImageInfo about;
      for (int part = 0; reader.next(read, about); ++part) {
        CHECK(read.values == read_by_openexr(folder / "s.exr", part).values);
      }
    }
  }
}
