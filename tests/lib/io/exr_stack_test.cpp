#include "io/exr_stack.hpp"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfDoubleAttribute.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputPart.h>
#include <OpenEXR/ImfIntAttribute.h>
#include <OpenEXR/ImfMultiPartInputFile.h>
#include <OpenEXR/ImfMultiPartOutputFile.h>
#include <OpenEXR/ImfOutputPart.h>
#include <OpenEXR/ImfPartType.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <doctest/doctest.h>
#include <sys/stat.h>

#include <cmath>
#include <limits>
#include <thread>

#include "lib/io/scratch.hpp"

using namespace vam;
using namespace vam::io;
using scratch::slurp;
using scratch::spill;
using scratch::status;

namespace {

model::StackInfo sinogram(int width, int height, int count) {
  model::StackInfo info;
  info.width = width;
  info.height = height;
  info.count = count;
  info.pixel_mm = 0.1;
  info.row_mm = 0.1;
  info.z_start_mm = -3;
  info.angle_step_deg = 1;
  info.units = "mJ/cm2";
  info.history = {"vam-slice 0.1.0 part.stl", "vam-sinogram 0.1.0"};
  info.extra["owner of the part, a rather long attribute name"] = "somebody";
  return info;
}

// Smooth stretches and noise, so that every compressor has chunks that shrink and chunks that do not.
Image picture(int width, int height, int seed) {
  Image image(width, height);
  unsigned state = 12345U + static_cast<unsigned>(seed);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      state = state * 1664525U + 1013904223U;
      image(x, y) = (y % 3 == 0) ? static_cast<float>(state >> 8) / 4096.0F : static_cast<float>(seed + x / 4);
    }
  }
  return image;
}

void write_stack(const std::string& path, const model::StackInfo& info, const StackOptions& options = {}) {
  StackWriter writer(path, info, options);
  for (int i = 0; i < info.count; ++i) writer.write(picture(info.width, info.height, i));
  writer.commit();
}

// A pipe in the file system: what is written there goes through the writer's and the reader's path for pipes.
struct Fifo {
  explicit Fifo(std::string name) : path(std::move(name)) { REQUIRE(mkfifo(path.c_str(), 0600) == 0); }
  std::string path;
};

// The judge: OpenEXR's own reader of multi-part files.
Image read_by_openexr(const std::string& path, int part) {
  Imf::MultiPartInputFile file(path.c_str(), 0, false);
  CHECK(file.partComplete(part));
  const auto window = file.header(part).dataWindow();
  Image image(window.max.x + 1, window.max.y + 1);
  Imf::FrameBuffer pixels;
  pixels.insert("Y", Imf::Slice::Make(Imf::FLOAT, image.values.data(), window));
  Imf::InputPart input(file, part);
  input.setFrameBuffer(pixels);
  input.readPixels(window.min.y, window.max.y);
  return image;
}

// A stack by OpenEXR's own writer, its parts' chunks in the given order of rows.
void write_by_openexr(const std::string& path, const model::StackInfo& info, Imf::Compression compression,
                      Imf::PixelType type, bool interleaved) {
  std::vector<Imf::Header> headers;
  for (int i = 0; i < info.count; ++i) {
    Imf::Header header(info.width, info.height);
    header.channels().insert("A", Imf::Channel(Imf::HALF));
    header.channels().insert("Y", Imf::Channel(type));
    header.compression() = compression;
    header.setName("part" + std::to_string(i));
    header.setType(Imf::SCANLINEIMAGE);
    header.insert("vam:kind", Imf::StringAttribute("frames"));
    header.insert("vam:space", Imf::StringAttribute("camera"));
    header.insert("vam:pixel_mm", Imf::DoubleAttribute(0.02));
    header.insert("vam:angle_deg", Imf::DoubleAttribute(7.5 * i));
    headers.push_back(header);
  }
  Imf::MultiPartOutputFile file(path.c_str(), headers.data(), info.count);
  std::vector<Image> images;
  std::vector<Imf::OutputPart> parts;
  std::vector<std::uint16_t> alpha(static_cast<std::size_t>(info.width) * static_cast<std::size_t>(info.height));
  for (int i = 0; i < info.count; ++i) images.push_back(picture(info.width, info.height, i));
  for (int i = 0; i < info.count; ++i) {
    parts.emplace_back(file, i);
    Imf::FrameBuffer pixels;
    const auto window = headers[static_cast<std::size_t>(i)].dataWindow();
    pixels.insert("A", Imf::Slice::Make(Imf::HALF, alpha.data(), window));
    pixels.insert("Y", Imf::Slice::Make(Imf::FLOAT, images[static_cast<std::size_t>(i)].values.data(), window));
    parts.back().setFrameBuffer(pixels);
  }
  const int step = interleaved ? 1 : info.height;
  for (int row = 0; row < info.height; row += step) {
    for (Imf::OutputPart& part : parts) part.writePixels(step);
  }
}

double resident_mib() {
  std::ifstream statm("/proc/self/statm");
  long pages = 0;
  statm >> pages >> pages;
  return static_cast<double>(pages) * static_cast<double>(sysconf(_SC_PAGESIZE)) / (1 << 20);
}

}  // namespace

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
      CHECK(reader.info().history == info.history);
      CHECK(reader.info().extra == info.extra);
      Image image;
      model::ImageInfo about;
      for (int i = 0; i < 20; ++i) {
        REQUIRE(reader.next(image, about));
        CHECK(about.z_mm == doctest::Approx(-3 + 0.1 * i));
        CHECK_FALSE(about.has_angle);
        const Image wanted = picture(37, 70, i);
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
    CHECK(slurp(folder / "piped.exr") == slurp(folder / "file.exr"));
    for (int i = 0; i < 5; ++i) {
      const Image read = read_by_openexr(folder / "piped.exr", i);
      if (!narrow) CHECK(read.values == picture(33, 12, i).values);
    }
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
  while (reader.next(image, about)) CHECK(image.values == picture(33, 40, count++).values);
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
    facts[static_cast<std::size_t>(i)] = {1.5, 60.0 * i + 0.01 * i * i, 0.1 * i, true, true};
  }
  const auto write = [&](const std::string& path, bool known) {
    StackWriter writer = known ? StackWriter(path, info, facts) : StackWriter(path, info);
    for (int i = 0; i < 6; ++i) writer.write(picture(4, 3, i), facts[static_cast<std::size_t>(i)]);
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
        const auto& wanted = facts[static_cast<std::size_t>(i)];
        CHECK(about.has_angle);
        CHECK(about.has_time);
        CHECK(about.angle_deg == wanted.angle_deg);
        CHECK(about.time_s == wanted.time_s);
        CHECK(about.z_mm == 1.5);
        CHECK(reader.about()[static_cast<std::size_t>(i)].angle_deg == wanted.angle_deg);
        CHECK(image.values == picture(4, 3, i).values);
      }
      CHECK(read_by_openexr(folder / "a.exr", 5).values == picture(4, 3, 5).values);
    }
  }
}

TEST_CASE("stacks of OpenEXR's own writer: other channels, types, compressions, interleaved parts") {
  const scratch::Folder folder;
  const auto info = sinogram(29, 64, 4);
  for (const auto compression : {Imf::NO_COMPRESSION, Imf::ZIP_COMPRESSION, Imf::RLE_COMPRESSION}) {
    for (const bool interleaved : {false, true}) {
      write_by_openexr(folder / "foreign.exr", info, compression, Imf::FLOAT, interleaved);
      StackReader reader(folder / "foreign.exr");
      CHECK(reader.info().kind == model::Kind::frames);
      CHECK(reader.info().count == 4);
      Image image;
      model::ImageInfo about;
      for (int i = 0; i < 4; ++i) {
        REQUIRE(reader.next(image, about));
        CHECK(image.values == picture(29, 64, i).values);
        CHECK(about.angle_deg == 7.5 * i);
      }
    }
  }
}

TEST_CASE("several stacks on one stream follow each other") {
  const scratch::Folder folder;
  write_stack(folder / "one.exr", sinogram(8, 4, 3));
  write_stack(folder / "two.exr", sinogram(8, 5, 2), {false, "none"});
  spill(folder / "both.exr", slurp(folder / "one.exr") + slurp(folder / "two.exr"));
  StackReader reader(folder / "both.exr");
  Image image;
  model::ImageInfo about;
  CHECK(reader.info().count == 3);
  CHECK(status([&] { reader.next_stack(); }) == 70);  // images are left
  for (int i = 0; i < 3; ++i) CHECK(reader.next(image, about));
  CHECK_FALSE(reader.next(image, about));
  REQUIRE(reader.next_stack());
  CHECK(reader.info().height == 5);
  for (int i = 0; i < 2; ++i) REQUIRE(reader.next(image, about));
  CHECK(image.values == picture(8, 5, 1).values);
  CHECK_FALSE(reader.next_stack());
}

TEST_CASE("part names grow with the number of parts, so that they sort") {
  const scratch::Folder folder;
  write_stack(folder / "s.exr", sinogram(1, 1, 10'001));
  Imf::MultiPartInputFile file((folder / "s.exr").c_str(), 0, false);
  CHECK(file.header(0).name() == "z00000");
  CHECK(file.header(10'000).name() == "z10000");
}

TEST_CASE("five thousand parts go through a pipe, into a file and out of it in constant memory") {
#ifdef __SANITIZE_ADDRESS__
  MESSAGE("skipped: the sanitizer keeps freed memory");
  return;
#endif
  const scratch::Folder folder;
  const auto info = sinogram(80, 64, 5000);  // 98 MiB of pixels
  // Headers and offset tables: about 2 kB a part on each side. Of the pixels only a few images may be held at a time.
#ifdef __SANITIZE_THREAD__
  constexpr double allowed_mib = 4 * 40;  // every byte has shadows
#else
  constexpr double allowed_mib = 40;
#endif
  const Image image = picture(80, 64, 1);
  const double before = resident_mib();
  double peak = before;
  const auto write = [&](const std::string& path, bool sample) {
    StackWriter writer(path, info, {false, "zip"});
    for (int i = 0; i < info.count; ++i) {
      writer.write(image);
      if (sample && i % 250 == 0) peak = std::max(peak, resident_mib());
    }
    writer.commit();
  };
  const auto read = [&](const std::string& path) {
    StackReader reader(path);
    Image got;
    model::ImageInfo about;
    int count = 0;
    for (; reader.next(got, about); ++count) {
      if (count % 250 == 0) peak = std::max(peak, resident_mib());
    }
    CHECK(count == 5000);
    CHECK(got.values == image.values);
  };
  const Fifo fifo(folder / "pipe");
  std::thread writer([&] { write(fifo.path, false); });
  read(fifo.path);
  writer.join();
  CHECK(peak - before < allowed_mib);
  write(folder / "s.exr", true);
  CHECK(peak - before < allowed_mib);
  read(folder / "s.exr");
  CHECK(peak - before < allowed_mib);
  MESSAGE("5,000 parts: " << peak - before << " MiB");
}

TEST_CASE("what is no stack is refused with 65") {
  const scratch::Folder folder;
  std::string line;
  const auto open = [&](const std::string& name) { return status([&] { StackReader reader(folder / name); }, &line); };
  spill(folder / "empty.exr", "");
  CHECK(open("empty.exr") == 65);
  CHECK(line.find("empty") != std::string::npos);
  spill(folder / "text.exr", "solid part");
  CHECK(open("text.exr") == 65);
  CHECK(line.find("not OpenEXR") != std::string::npos);

  const Imf::Header plain = [] {
    Imf::Header header(4, 4);
    header.channels().insert("R", Imf::Channel(Imf::FLOAT));
    header.setName("a");
    header.setType(Imf::SCANLINEIMAGE);
    return header;
  }();
  { Imf::MultiPartOutputFile file((folder / "rgb.exr").c_str(), &plain, 1); }
  CHECK(open("rgb.exr") == 65);
  CHECK(line.find("no channel Y, but R") != std::string::npos);
  Imf::Header kindless = plain;
  kindless.channels().insert("Y", Imf::Channel(Imf::FLOAT));
  { Imf::MultiPartOutputFile file((folder / "kindless.exr").c_str(), &kindless, 1); }
  CHECK(open("kindless.exr") == 65);
  CHECK(line.find("vam:kind") != std::string::npos);
  CHECK(open("absent.exr") == 66);
}

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
  std::string line;
  CHECK(status([&] { StackReader reader(folder / "huge.exr"); }, &line) == 65);
  CHECK(line.find("2000000001 x 2000000001") != std::string::npos);
}

TEST_CASE("a pixel that is no number is refused, with its place") {
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
  std::string line;
  CHECK(status([&] { reader.next(image, about); }, &line) == 65);
  CHECK(line.find("pixel 3, 2 of image 1") != std::string::npos);
}

TEST_CASE("half is refused where it cannot hold a value") {
  const scratch::Folder folder;
  CHECK(status([&] {
          StackWriter(folder / "s.exr", sinogram(5, 4, 1), {true, "rle"}).write(Image(5, 4, 70000));
        }) == 65);
  CHECK(folder.count() == 0);
}

TEST_CASE("images that were announced must come, in number and size") {
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

TEST_CASE("a cut stack is 65 wherever it is cut, and a flipped bit never crashes") {
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

TEST_CASE("wrong kind or space is refused by name") {
  auto info = sinogram(4, 4, 4);
  CHECK(status([&] { require("a.exr", info, model::Kind::sinogram, model::Space::virtual_); }) == 0);
  CHECK(status([&] { require("a.exr", info, model::Kind::sinogram); }) == 0);
  std::string line;
  CHECK(status([&] { require("a.exr", info, model::Kind::frames, model::Space::projector); }, &line) == 65);
  CHECK(line == "a.exr: holds sinogram (virtual), but frames (projector) is needed");
  CHECK(status([&] { require("-", info, model::Kind::frames); }, &line) == 65);
  CHECK(line == "stdin: holds sinogram (virtual), but frames is needed");
}
