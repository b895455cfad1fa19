// SPDX-License-Identifier: GPL-3.0-or-later
// Video: FFV1 in Matroska, lossless, which may be printed from; H.264 in MP4, for looking at.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/pixels.hpp"
#include "io/stream/seal.hpp"

namespace vam::io {

struct VideoFormat {
  int width = 0;
  int height = 0;
  int bits = 8;            // of the frames: 1, 2, 4, 8, 10 or 16
  double fps = 0;          // frames per second
  std::string comment;     // lines that go into the file's metadata
  bool colour = false;     // H.264 of RgbImages
  std::string facts = {};  // of the frames: lines that begin with "vam:", behind those of the comment
  // Of one that is read:
  bool checksums = false;                     // its container has some, and all are right
  std::optional<Digest> seal = std::nullopt;  // of the decoded levels, to which reading to the end holds them
};

/// Writes frames of one size. The name chooses the format:
///  .mkv  FFV1, lossless: gray for up to 8 bits (fewer are spread over 0..255, so that players show the right
///        brightness), gray10le for 10 and gray16le for 16 with the levels as they are.
///  .mp4  H.264 yuv420p, 8 bits, full range, odd sizes padded with their last row or column. Errs by up to 59 of 255 on
///        fine patterns: never print from it.
/// FFV1 in a file, not in a pipe, ends in a seal of its levels.
/// The bytes do not depend on the machine or the number of threads. A file appears under its name at commit() only.
/// Throws Error: usage (another ending, a build without video), absent (no H.264 encoder), no_output, io.
class VideoWriter {
 public:
  VideoWriter(const std::string& path, const VideoFormat& format);
  ~VideoWriter();
  void write(const GreyImage& frame);
  /// Of a video in colour.
  void write(const RgbImage& frame);
  /// Frames 0 .. count - 1, encoded side by side where the format allows it.
  void write(int count, const std::function<const GreyImage&(int)>& frame);
  void commit();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Reads the first video stream, front to back, as grey: colour as luma, limited range (black 16, white 235 of 255, as
/// of H.264 that states nothing else) widened to the full one, in 16 bits; turned as the video states that it is to be
/// shown. Throws Error: no_input, data (no video, truncated, a pixel format that is not read).
class VideoReader {
 public:
  explicit VideoReader(const std::string& path);
  ~VideoReader();
  /// Size, depth (8, 10 or 16 bits; frames of limited range have 16) and rate.
  [[nodiscard]] const VideoFormat& format() const;
  /// False after the last frame. Throws Fault::data where all frames are not those that were sealed.
  bool next(GreyImage& frame);

 private:
  friend std::vector<double> video_frame_times(const std::string& path);
  struct State;
  std::unique_ptr<State> state_;
};

/// When each frame of the first video stream is shown, in s since the first one, and when the last one ends, without
/// decoding them; even ones where a container rounds all of these to a unit much shorter than a frame. Throws as
/// VideoReader does.
[[nodiscard]] std::vector<double> video_frame_times(const std::string& path);

}  // namespace vam::io
