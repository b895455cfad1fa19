// SPDX-License-Identifier: GPL-3.0-or-later
// Movies in colour, for people: H.264 in MP4.
#pragma once

#include <memory>
#include <string>

#include "base/pixels.hpp"

namespace vam::io {

/// Frames of one size; an odd one is padded with its last row or column. The bytes do not depend on the machine or the
/// number of threads. The file appears under its name at commit() only. Throws Error: usage (an ending that is not
/// .mp4, a build without video), absent (no H.264 encoder), no_output, io.
class Movie {
 public:
  Movie(const std::string& path, int width, int height, double fps, const std::string& comment);
  ~Movie();
  void write(const RgbImage& frame);
  void commit();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace vam::io
