// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/image/movie.hpp"

#include "base/error.hpp"
#include "io/image/private/video.hpp"

namespace vam::io {

struct Movie::State {
  VideoWriter video;
};

Movie::Movie(const std::string& path, int width, int height, double fps, const std::string& comment) {
  if (!path.ends_with(".mp4")) throw Error{Fault::usage, path + ": a movie ends in .mp4"};
  const VideoFormat format{.width = width, .height = height, .fps = fps, .comment = comment, .colour = true};
  state_.reset(new State{VideoWriter(path, format)});
}

Movie::~Movie() = default;

void Movie::write(const RgbImage& frame) { state_->video.write(frame); }

void Movie::commit() { state_->video.commit(); }

}  // namespace vam::io
