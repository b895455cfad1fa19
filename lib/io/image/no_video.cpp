// SPDX-License-Identifier: GPL-3.0-or-later
// In the place of video_reader.cpp and video_writer.cpp where the tools are built with -DVAM_VIDEO=OFF.
#include "base/error.hpp"
#include "io/image/video.hpp"

namespace vam::io {

struct VideoWriter::State {};
struct VideoReader::State {
  VideoFormat format;
};

namespace {

Error no_video(Fault fault, const std::string& path) {
  return Error{fault, path + ": video is not built in (VAM_VIDEO=OFF); use a folder of numbered PNG images"};
}

}  // namespace

VideoWriter::VideoWriter(const std::string& path, const VideoFormat&) { throw no_video(Fault::usage, path); }
VideoWriter::~VideoWriter() = default;
void VideoWriter::write(const GreyImage&) {}
void VideoWriter::write(const RgbImage&) {}
void VideoWriter::write(int, const std::function<const GreyImage&(int)>&) {}
void VideoWriter::commit() {}

VideoReader::VideoReader(const std::string& path) { throw no_video(Fault::no_input, path); }
VideoReader::~VideoReader() = default;
const VideoFormat& VideoReader::format() const { return state_->format; }
bool VideoReader::next(GreyImage&) { return false; }

std::vector<double> video_frame_times(const std::string& path) { throw no_video(Fault::no_input, path); }

}  // namespace vam::io
