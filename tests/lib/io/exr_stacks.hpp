// SPDX-License-Identifier: GPL-3.0-or-later
// Stacks for the tests, and OpenEXR's own reader for their judge.
#pragma once

#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputPart.h>
#include <OpenEXR/ImfMultiPartInputFile.h>
#include <sys/stat.h>

#include <utility>

#include "io/exr/stack.hpp"
#include "lib/io/scratch.hpp"
#include "testing.hpp"

namespace vam::stacks {

using scratch::slurp;
using scratch::spill;
using scratch::status;

inline model::StackInfo sinogram(int width, int height, int count) {
  model::StackInfo info{.width = width,
                        .height = height,
                        .count = count,
                        .pixel_mm = 0.1,
                        .row_mm = 0.1,
                        .z_start_mm = -3,
                        .angle_step_deg = 1,
                        .units = "mJ/cm2",
                        .history = {"vam-slice 0.1.0 part.stl", "vam-sinogram 0.1.0"}};
  info.extra["owner of the part, a rather long attribute name"] = "somebody";
  return info;
}

// Smooth stretches and noise, so that every compressor has chunks that shrink and chunks that do not.
inline Image pattern(int width, int height, int seed) {
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

inline void write_stack(const std::string& path, const model::StackInfo& info, const io::StackOptions& options = {}) {
  io::StackWriter writer(path, info, options);
  for (int i = 0; i < info.count; ++i) writer.write(pattern(info.width, info.height, i));
  writer.commit();
}

// A pipe in the file system: what is written there goes through the writer's and the reader's path for pipes.
struct Fifo {
  explicit Fifo(std::string name) : path(std::move(name)) { REQUIRE(mkfifo(path.c_str(), 0600) == 0); }
  std::string path;
};

// The judge: OpenEXR's own reader of multi-part files.
inline Image read_by_openexr(const std::string& path, int part) {
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

}  // namespace vam::stacks
