// SPDX-License-Identifier: GPL-3.0-or-later
// libav, loaded when the first video is opened: its 130 libraries would take most of the start of every tool that knows
// videos. Its headers say what the functions are; nothing is linked. Its objects with owners, its status codes as
// Errors.
#pragma once

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
#include <libavutil/crc.h>
#include <libavutil/imgutils.h>
#include <libavutil/opt.h>
}

#include <memory>
#include <string>

#include "base/error.hpp"
#include "base/system_error.hpp"

// Every function of libav that is called, by library.
// clang-format off
#define VAM_AVUTIL_FUNCTIONS(X)                                                                                       \
  X(av_crc) X(av_crc_get_table) X(av_d2q) X(av_dict_free) X(av_dict_get) X(av_dict_set) X(av_frame_alloc)             \
  X(av_frame_free) X(av_frame_get_buffer) X(av_frame_make_writable) X(av_freep) X(av_log_set_level) X(av_malloc)      \
  X(av_opt_set) X(av_opt_set_int) X(av_strerror)
#define VAM_AVCODEC_FUNCTIONS(X)                                                                                      \
  X(av_packet_alloc) X(av_packet_free) X(av_packet_rescale_ts) X(av_packet_unref) X(avcodec_alloc_context3)           \
  X(avcodec_find_encoder) X(avcodec_find_encoder_by_name) X(avcodec_free_context) X(avcodec_open2)                    \
  X(avcodec_parameters_from_context) X(avcodec_parameters_to_context) X(avcodec_receive_frame)                        \
  X(avcodec_receive_packet) X(avcodec_send_frame) X(avcodec_send_packet)
#define VAM_AVFORMAT_FUNCTIONS(X)                                                                                     \
  X(av_find_best_stream) X(av_interleaved_write_frame) X(av_read_frame) X(av_write_trailer)                           \
  X(avformat_alloc_output_context2) X(avformat_close_input) X(avformat_find_stream_info) X(avformat_free_context)     \
  X(av_stream_get_side_data) X(avformat_new_stream) X(avformat_open_input) X(avformat_write_header)                   \
  X(avio_alloc_context) X(avio_context_free) X(avio_flush)
// clang-format on

namespace vam::io::av {

struct AvApi {
#define VAM_POINTER(name) decltype(&::name) name;  // NOLINT(bugprone-macro-parentheses): it is declared here
  VAM_AVUTIL_FUNCTIONS(VAM_POINTER)
  VAM_AVCODEC_FUNCTIONS(VAM_POINTER)
  VAM_AVFORMAT_FUNCTIONS(VAM_POINTER)
#undef VAM_POINTER
};

/// The one of this process. Throws Fault::absent when the machine does not have the release that this was built with.
const AvApi& api();

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
