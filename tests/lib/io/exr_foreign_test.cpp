// SPDX-License-Identifier: GPL-3.0-or-later
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfDoubleAttribute.h>
#include <OpenEXR/ImfMultiPartOutputFile.h>
#include <OpenEXR/ImfOutputPart.h>
#include <OpenEXR/ImfPartType.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <doctest/doctest.h>

#include <cstdint>
#include <string>
#include <vector>

#include "lib/io/exr_stacks.hpp"

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
  CHECK(line.find("no channel Y, but R") != std::string::npos);
  Imf::Header kindless = plain;
  kindless.channels().insert("Y", Imf::Channel(Imf::FLOAT));
  { Imf::MultiPartOutputFile file((folder / "kindless.exr").c_str(), &kindless, 1); }
  CHECK(open("kindless.exr") == 65);
  CHECK(line.find("vam:kind") != std::string::npos);
  CHECK(open("absent.exr") == 66);
}
