// SPDX-License-Identifier: GPL-3.0-or-later
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfDoubleAttribute.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfMultiPartOutputFile.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfOutputPart.h>
#include <OpenEXR/ImfPartType.h>
#include <OpenEXR/ImfStringAttribute.h>

#include <utility>

#include "io/exr/stack.hpp"
#include "lib/io/exr_stacks.hpp"
#include "testing.hpp"

using namespace vam;
using namespace vam::io;
using namespace vam::stacks;

namespace {

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
  std::vector<std::uint16_t> alpha(static_cast<std::size_t>(info.width) * info.height);
  for (int i = 0; i < info.count; ++i) images.push_back(pattern(info.width, info.height, i));
  for (int i = 0; i < info.count; ++i) {
    parts.emplace_back(file, i);
    Imf::FrameBuffer pixels;
    const auto window = headers[i].dataWindow();
    pixels.insert("A", Imf::Slice::Make(Imf::HALF, alpha.data(), window));
    pixels.insert("Y", Imf::Slice::Make(Imf::FLOAT, images[i].values.data(), window));
    parts.back().setFrameBuffer(pixels);
  }
  const int step = interleaved ? 1 : info.height;
  for (int row = 0; row < info.height; row += step) {
    for (Imf::OutputPart& part : parts) part.writePixels(step);
  }
}

}  // namespace

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
        CHECK(image.values == pattern(29, 64, i).values);
        CHECK(about.angle_deg == 7.5 * i);
      }
    }
  }
}

TEST_CASE("images of a stack that contradict each other are refused with both values") {
  const scratch::Folder folder;
  using Change = std::function<void(Imf::Header&, int)>;
  const auto refusal = [&](const Change& change) {
    std::vector<Imf::Header> headers;
    for (int i = 0; i < 4; ++i) {
      Imf::Header& header = headers.emplace_back(4, 4);
      header.channels().insert("Y", Imf::Channel(Imf::FLOAT));
      header.setName("z" + std::to_string(i));
      header.setType(Imf::SCANLINEIMAGE);
      for (const auto& [name, text] : {std::pair{"kind", "sinogram"}, {"space", "virtual"}, {"units", "mm"}}) {
        header.insert("vam:" + std::string(name), Imf::StringAttribute(text));
      }
      for (const auto& [name, number] : {std::pair{"pixel_mm", 0.5},
                                         {"row_mm", 0.5},
                                         {"z_mm", 0.5 * i - 3},
                                         {"angle_start_deg", 0.0},
                                         {"angle_step_deg", 90.0}}) {
        header.insert("vam:" + std::string(name), Imf::DoubleAttribute(number));
      }
      change(header, i);
    }
    { Imf::MultiPartOutputFile file((folder / "s.exr").c_str(), headers.data(), 4); }
    std::string line;
    const int ended = status([&] { StackReader reader(folder / "s.exr"); }, &line);
    CHECK(ended == (line.empty() ? 0 : 65));
    return line;
  };
  const auto number = [](const char* name, double value, int from = 2) {
    return [=](Imf::Header& header, int i) {
      if (i >= from) header.insert(name, Imf::DoubleAttribute(value));
    };
  };
  const auto text = [](const char* name, const char* value) {
    return [=](Imf::Header& header, int i) {
      if (i >= 2) header.insert(name, Imf::StringAttribute(value));
    };
  };
  CHECK(refusal([](Imf::Header&, int) {}).empty());
  CHECK(has(refusal(number("vam:z_mm", -2.001)), "image 3 has vam:z_mm -2.001"));
  CHECK(has(refusal(number("vam:pixel_mm", 0.25)), "image 2 has vam:pixel_mm 0.25, but image 0 has 0.5"));
  CHECK(has(refusal(number("vam:row_mm", 0.4)), "image 2 has vam:row_mm 0.4, but image 0 has 0.5"));
  CHECK(has(refusal(number("vam:angle_start_deg", 90)), "image 2 has vam:angle_start_deg 90, but image 0 has 0"));
  CHECK(has(refusal(number("vam:angle_step_deg", -90)), "image 2 has vam:angle_step_deg -90, but image 0 has 90"));
  CHECK(has(refusal(text("vam:space", "projector")), "image 2 has vam:space projector, but image 0 has virtual"));
  CHECK(has(refusal(text("vam:units", "1/rad")), "image 2 has vam:units '1/rad', but image 0 has 'mm'"));
  CHECK(
      has(refusal(number("vam:z_mm", 0, 0)), "image 1 has vam:z_mm 0, but its place is 0.5, 1 x vam:row_mm 0.5 above"));
  CHECK(has(refusal([](Imf::Header& header, int i) { header.insert("vam:z_mm", Imf::DoubleAttribute(-i)); }),
            "image 1 has vam:z_mm -1, but its place is 0.5"));
  CHECK(has(refusal([](Imf::Header& header, int) { header.erase("vam:z_mm"); }), "image 1 has no vam:z_mm"));
  for (const double pitch_mm : {0.0, -0.5}) {
    CHECK(has(refusal([=](Imf::Header& header, int i) {
                header.insert("vam:row_mm", Imf::DoubleAttribute(pitch_mm));
                header.insert("vam:z_mm", Imf::DoubleAttribute(i * pitch_mm));
              }),
              "its slice pitch, vam:row_mm, is"));
  }
  const std::string long_text((1 << 20) + 1, 'x');
  CHECK(has(refusal(text("vam:history", long_text.c_str())), "vam:history has 1048577 bytes, more than 1 MiB"));
}

TEST_CASE("a file that is not a stack is status 65") {
  const scratch::Folder folder;
  std::string line;
  const auto open = [&](const std::string& name) { return status([&] { StackReader reader(folder / name); }, &line); };
  spill(folder / "empty.exr", "");
  CHECK(open("empty.exr") == 65);
  CHECK(line.find("empty") != std::string::npos);
  spill(folder / "text.exr", "solid part");
  CHECK(open("text.exr") == 65);
  CHECK(line.find("not OpenEXR") != std::string::npos);
  spill(folder / "array.exr", "\x93NUMPY\1");
  CHECK(open("array.exr") == 65);
  CHECK(line.ends_with(
      "array.exr: is a NumPy array (.npy), not a stack (OpenEXR); vam-convert makes a volume or a stack of it"));

  const Imf::Header plain = [] {
    Imf::Header header(4, 4);
    header.channels().insert("R", Imf::Channel(Imf::FLOAT));
    header.setName("a");
    header.setType(Imf::SCANLINEIMAGE);
    return header;
  }();
  { Imf::MultiPartOutputFile file((folder / "rgb.exr").c_str(), &plain, 1); }
  CHECK(open("rgb.exr") == 65);
  CHECK(line.find("no channel Y, but R; to take R: oiiotool -a FILE --ch 'Y=R' -o FILE.Y.exr") != std::string::npos);
  Imf::Header kindless = plain;
  kindless.channels().insert("Y", Imf::Channel(Imf::FLOAT));
  { Imf::MultiPartOutputFile file((folder / "kindless.exr").c_str(), &kindless, 1); }
  CHECK(open("kindless.exr") == 65);
  CHECK(line.find("vam:kind") != std::string::npos);
  Imf::Header cropped = kindless;
  cropped.displayWindow().max.x = 9;
  Imf::Header wide = kindless;
  wide.pixelAspectRatio() = 2;
  for (const auto& [header, what] : {std::pair{cropped, "a part of its image only; oiiotool FILE --croptofull"},
                                     std::pair{wide, "pixels 2 times as wide as high; resample it, or if"}}) {
    { Imf::MultiPartOutputFile file((folder / "odd.exr").c_str(), &header, 1); }
    CHECK(open("odd.exr") == 65);
    CHECK(has(line, what));
  }
  CHECK(open("absent.exr") == 66);
}

TEST_CASE("bytes behind the end of an EXR image are refused with their number") {
  const scratch::Folder folder;
  const std::string path = folder / "one.exr";
  std::vector<float> values{1, 2, 3, 4, 5, 6};
  for (const Imf::Compression how : {Imf::NO_COMPRESSION, Imf::ZIP_COMPRESSION, Imf::PIZ_COMPRESSION}) {
    {
      Imf::Header header(3, 2);
      header.compression() = how;
      header.channels().insert("Y", Imf::Channel(Imf::FLOAT));
      Imf::OutputFile file(path.c_str(), header);
      Imf::FrameBuffer pixels;
      pixels.insert("Y", Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(values.data()), 4, 12));
      file.setFrameBuffer(pixels);
      file.writePixels(2);
    }
    CHECK(read_exr_image(path).values == values);
    const std::string bytes = scratch::slurp(path);
    spill(path, bytes + "junk!");
    CHECK(has(error_of([&] { (void)read_exr_image(path); }, Fault::data),
              "one.exr: has 5 bytes behind the end of its EXR image; it is damaged, or holds several images"));
    spill(path, bytes.substr(0, bytes.size() - 1));
    CHECK(status([&] { (void)read_exr_image(path); }) == 65);
  }
}
