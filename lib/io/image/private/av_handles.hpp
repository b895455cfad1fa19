// SPDX-License-Identifier: GPL-3.0-or-later
// Private to video_*.cpp: libav's objects with owners, and its status codes as Errors.
#pragma once

#include <memory>
#include <string>

#include "base/error.hpp"
#include "base/system_error.hpp"
#include "io/image/private/av_library.hpp"

namespace vam::io::av {

struct Free {
  void operator()(AVCodecContext* context) const { api().avcodec_free_context(&context); }
  void operator()(AVFrame* frame) const { api().av_frame_free(&frame); }
  void operator()(AVPacket* packet) const { api().av_packet_free(&packet); }
};
using Codec = std::unique_ptr<AVCodecContext, Free>;
using AvFrame = std::unique_ptr<AVFrame, Free>;
using Packet = std::unique_ptr<AVPacket, Free>;

/// The status itself, unless it is negative: then an Error "<name>: <what> failed: <libav's words>".
inline int check(int status, Fault fault, const std::string& name, const char* what) {
  if (status >= 0) return status;
  if (status == AVERROR(EMFILE) || status == AVERROR(ENFILE))
    throw system_error(fault, name + ": " + what, AVUNERROR(status));
  char words[AV_ERROR_MAX_STRING_SIZE];
  api().av_strerror(status, static_cast<char*>(words), sizeof words);
  throw Error{fault, name + ": " + what + " failed: " + static_cast<char*>(words)};
}

}  // namespace vam::io::av
