// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <optional>

#include "base/index.hpp"
#include "base/text/format_version.hpp"
#include "io/image/private/av_library.hpp"
#include "io/image/private/matroska.hpp"
#include "io/image/video.hpp"

namespace vam::io {

namespace {

// How the brightness of a pixel is stored.
struct PixelLayout {
  int bits = 0;          // of a frame as read; 0: not a format that is known
  int stored_bits = 0;   // of a value in the file
  bool limited = false;  // black is 16 and white 235 of 255, unless the video states the full range
  bool rgb = false;
};

PixelLayout layout_of(int pixel_format) {
  switch (pixel_format) {
    case AV_PIX_FMT_GRAY8:
    case AV_PIX_FMT_YUVJ420P:
    case AV_PIX_FMT_YUVJ422P:
    case AV_PIX_FMT_YUVJ444P:
      return {8, 8};
    case AV_PIX_FMT_GRAY10LE:
      return {10, 10};
    case AV_PIX_FMT_GRAY16LE:
      return {16, 16};
    case AV_PIX_FMT_YUV420P:
    case AV_PIX_FMT_YUV422P:
    case AV_PIX_FMT_YUV444P:
      return {8, 8, true};
    case AV_PIX_FMT_YUV420P10LE:
      return {10, 10, true};
    case AV_PIX_FMT_GBRP:
    case AV_PIX_FMT_BGR0:
      return {16, 8, false, true};  // the luma of a blue pixel has more than 8 bits
    default:
      return {};
  }
}

// Levels of limited range in 16 bits, as 8 hold only some of what the range was widened to [ITU-R BT.709 section 4].
std::uint16_t widened(int level, int stored_bits) {
  const int black = 16 << (stored_bits - 8), white = 235 << (stored_bits - 8);
  return static_cast<std::uint16_t>((std::clamp(level, black, white) - black) * 65535 / (white - black));
}

// [ITU-R BT.601 section 2.5.1], as image files are read.
std::uint16_t luma(int red, int green, int blue) {
  return static_cast<std::uint16_t>((299 * red + 587 * green + 114 * blue) * 257 / 1000);
}

// Of one frame: every slice ends in its size (3 bytes), where it has checksums a status and the CRC-32 by which the
// whole slice has the remainder 0 (RFC 9043 section 4.9). libav hides a damaged slice behind the last frame's.
enum class SliceState { right, wrong, broken };

SliceState judged_slices(const std::uint8_t* bytes, std::size_t size, bool checksums) {
  const std::size_t footer = checksums ? 8 : 3;
  bool right = true;
  while (size > 0) {
    if (size < footer) return SliceState::broken;
    const std::uint8_t* at = bytes + size - footer;
    const std::size_t slice = (std::size_t{at[0]} << 16 | std::size_t{at[1]} << 8 | at[2]) + footer;
    if (slice > size) return SliceState::broken;
    size -= slice;
    right = right &&
            (!checksums || av::api().av_crc(av::api().av_crc_get_table(AV_CRC_32_IEEE), 0, bytes + size, slice) == 0);
  }
  return right ? SliceState::right : SliceState::wrong;
}

// How players turn what is stored: pixel (x, y) to (a x + c y, b x + d y), but for a shift.
struct Turn {
  int a = 1, b = 0, c = 0, d = 1;
};

// Nine numbers, those of the turn in 1/65536 [libavutil/display.h].
Turn turn_of(const AVStream& stream, const std::string& path) {
  std::size_t size = 0;
  const std::uint8_t* stated = av::api().av_stream_get_side_data(&stream, AV_PKT_DATA_DISPLAYMATRIX, &size);
  std::array<std::int32_t, 9> matrix{};
  if (stated == nullptr || size < sizeof matrix) return {};
  std::memcpy(matrix.data(), stated, sizeof matrix);
  constexpr int one = 1 << 16;
  const Turn turn{matrix[0] / one, matrix[1] / one, matrix[3] / one, matrix[4] / one};
  const bool whole = std::all_of(matrix.begin(), matrix.begin() + 5, [](int value) { return value % one == 0; });
  const auto [a, b, c, d] = turn;
  if (whole && a * a + b * b == 1 && c * c + d * d == 1 && std::abs(a * d - b * c) == 1) return turn;
  throw Error{Fault::data, path +
                               ": is to be shown turned by no multiple of 90 degrees, or scaled; write it as it is "
                               "to be shown"};
}

}  // namespace

struct VideoReader::State {
  std::string path;
  VideoFormat format;
  std::string version;  // empty: not stated
  PixelLayout layout;
  Turn turn;
  AVFormatContext* container = nullptr;
  int stream = -1;
  av::Codec codec;
  av::AvFrame frame{av::api().av_frame_alloc()};
  av::Packet packet{av::api().av_packet_alloc()};
  std::int64_t announced = 0;     // frames; 0: not known
  std::vector<double> times_s;    // at which the packets so far are shown
  double end_s = 0;               // of the last one of them
  std::optional<VideoSeal> read;  // of the frames so far, where there is a seal
  bool held = false;              // to the seal

  ~State() { av::api().avformat_close_input(&container); }

  int check(int status, const char* what) const { return av::check(status, Fault::data, path, what); }

  void open() {
    av::check(av::api().avformat_open_input(&container, path.c_str(), nullptr, nullptr), Fault::data, path,
              "opening the video");
    if (const auto* stated = av::api().av_dict_get(container->metadata, video_version, nullptr, 0)) {
      version = stated->value;
      if (const std::string why = FormatKind("video").objection(version); !why.empty())
        throw Error{Fault::data, path + ": " + why};
    }
    check(av::api().avformat_find_stream_info(container, nullptr), "reading the video");
    const AVCodec* decoder = nullptr;
    stream = check(av::api().av_find_best_stream(container, AVMEDIA_TYPE_VIDEO, -1, -1, &decoder, 0),
                   "finding a video stream");
    const AVStream& found = *container->streams[stream];
    codec.reset(av::api().avcodec_alloc_context3(decoder));
    check(av::api().avcodec_parameters_to_context(codec.get(), found.codecpar), "video decoder");
    check(av::api().avcodec_open2(codec.get(), decoder, nullptr), "video decoder");
    turn = turn_of(found, path);
    format.width = turn.a != 0 ? codec->width : codec->height;
    format.height = turn.a != 0 ? codec->height : codec->width;
    layout = layout_of(codec->pix_fmt);
    format.bits = layout.bits;
    format.fps = av_q2d(found.avg_frame_rate);
    if (format.bits == 0)
      throw Error{Fault::data, path + ": its pixel format is not read; write gray, gray16le, yuv420p or bgr0"};
    const bool steady = container->nb_streams == 1 && av_cmp_q(found.avg_frame_rate, found.r_frame_rate) == 0;
    if (codec->codec_id == AV_CODEC_ID_FFV1 && steady && container->duration > 0) {
      announced = std::llround(static_cast<double>(container->duration) / AV_TIME_BASE * format.fps);
    }
    if (const AVDictionaryEntry* entry = av::api().av_dict_get(container->metadata, "comment", nullptr, 0))
      format.comment = entry->value;
    if (const std::size_t end = format.comment.find("\nvam:"); end != std::string::npos) {
      format.facts = format.comment.substr(end + 1);
      format.comment.resize(end);
    }
  }

  // The next packet of the stream; false at the end.
  bool read_packet() {
    int status = av::api().av_read_frame(container, packet.get());
    while (status >= 0 && packet->stream_index != stream) {
      av::api().av_packet_unref(packet.get());
      status = av::api().av_read_frame(container, packet.get());
    }
    if (status != AVERROR_EOF) check(status, "reading the video");
    if (status >= 0) check_packet();
    if (status < 0 && ours() && announced > 0 && count_of(times_s) != announced) {
      throw Error{Fault::data, path + ": the video has " + std::to_string(times_s.size()) + " of " +
                                   std::to_string(announced) + " frames; write it again"};
    }
    if (status < 0 && !ours()) require_end();
    return status >= 0;
  }

  // Their frames follow each other at even times, from 0 on: as many as the duration has.
  [[nodiscard]] bool ours() const { return format.seal.has_value() || format.comment.starts_with("vam-"); }

  // Of other programs' videos, which may begin later than at 0 and leave frames out.
  void require_end() const {
    if (announced == 0) return;
    const auto missing = std::llround((static_cast<double>(container->duration) / AV_TIME_BASE - end_s) * format.fps);
    if (missing < 1) return;
    throw Error{Fault::data, path + ": the video ends after " + std::to_string(times_s.size()) + " frames, " +
                                 std::to_string(missing) + " before the end that it states; write it again"};
  }

  void check_packet() {
    if ((packet->flags & AV_PKT_FLAG_DISCARD) != 0) return;  // before the beginning that an MP4 states
    const double tick_s = av_q2d(container->streams[stream]->time_base);
    const double period_s = format.fps > 0 ? 1 / format.fps : 0;
    const bool timed = packet->pts != AV_NOPTS_VALUE;
    times_s.push_back(timed ? tick_s * static_cast<double>(packet->pts) : period_s * count_of(times_s));
    const double shown_s = packet->duration > 0 ? tick_s * static_cast<double>(packet->duration) : period_s;
    end_s = std::max(end_s, times_s.back() + shown_s);
    if (codec->codec_id != AV_CODEC_ID_FFV1 || codec->extradata_size == 0) return;  // before version 3: no slices
    const auto size = static_cast<std::size_t>(packet->size);
    SliceState judged = judged_slices(packet->data, size, true);
    if (judged == SliceState::broken) judged = judged_slices(packet->data, size, false);
    if (judged == SliceState::right) return;
    throw Error{Fault::data,
                path + ": frame " + std::to_string(times_s.size() - 1) + " is damaged; write the video again"};
  }

  // With the last frame, or when there is no more.
  void hold(bool at_end) {
    if (!read || held || (!at_end && read->frames() != announced)) return;
    if (read->digest() != *format.seal) {
      throw Error{Fault::data, path + ": the video changed after it was written (sealed " + shortened(*format.seal) +
                                   ", read " + shortened(read->digest()) + "); write it again"};
    }
    held = true;
  }

  // Grey, yuvj and RGB pixels are of the full range whatever the video states, as libswscale, too, takes them.
  [[nodiscard]] bool is_narrow() const { return layout.limited && frame->color_range != AVCOL_RANGE_JPEG; }

  [[nodiscard]] int value(int plane, std::ptrdiff_t byte, int y) const {
    return frame->data[plane][static_cast<std::ptrdiff_t>(y) * frame->linesize[plane] + byte];
  }

  [[nodiscard]] std::uint16_t level(int x, int y) const {
    const std::ptrdiff_t i = x;
    if (codec->pix_fmt == AV_PIX_FMT_GBRP) return luma(value(2, i, y), value(0, i, y), value(1, i, y));
    if (layout.rgb) return luma(value(0, 4 * i + 2, y), value(0, 4 * i + 1, y), value(0, 4 * i, y));
    if (layout.stored_bits == 8) return static_cast<std::uint16_t>(value(0, i, y));
    return static_cast<std::uint16_t>(value(0, 2 * i, y) | value(0, 2 * i + 1, y) << 8);
  }

  // Feeds packets until the decoder has a frame; false at the end.
  bool decode() {
    for (;;) {
      const int status = av::api().avcodec_receive_frame(codec.get(), frame.get());
      if (status == AVERROR_EOF) return false;
      if (status != AVERROR(EAGAIN)) {
        check(status, "decoding the video");
        if (frame->decode_error_flags != 0) throw Error{Fault::data, path + ": a frame is damaged"};
        return true;
      }
      const bool more = read_packet();
      check(av::api().avcodec_send_packet(codec.get(), more ? packet.get() : nullptr), "decoding the video");
      av::api().av_packet_unref(packet.get());
    }
  }
};

VideoReader::VideoReader(const std::string& path) : state_(std::make_unique<State>()) {
  if (!std::filesystem::exists(path)) throw Error{Fault::no_input, path + ": cannot open: " + std::strerror(ENOENT)};
  const MatroskaProof proof = require_whole_matroska(path);
  av::api().av_log_set_level(AV_LOG_QUIET);
  state_->path = path;
  state_->open();
  VideoFormat& format = state_->format;
  format.checksums = proof.checksums;
  format.seal = proof.seal;
  if (format.seal) state_->read.emplace(format.width, format.height, format.bits, state_->version, format.facts);
}

VideoReader::~VideoReader() = default;

const VideoFormat& VideoReader::format() const { return state_->format; }

bool VideoReader::next(GreyImage& image) {
  State& s = *state_;
  if (!s.decode()) {
    s.hold(true);
    return false;
  }
  const bool narrow = s.is_narrow();
  const auto [a, b, c, d] = s.turn;
  const int columns = s.frame->width, rows = s.frame->height;
  image = GreyImage(a != 0 ? columns : rows, a != 0 ? rows : columns, narrow ? 16 : s.format.bits);
  const int left = a + c < 0 ? image.width - 1 : 0, top = b + d < 0 ? image.height - 1 : 0;
  for (int y = 0; y < rows; ++y) {
    for (int x = 0; x < columns; ++x) {
      const std::uint16_t level = s.level(x, y);
      image(left + a * x + c * y, top + b * x + d * y) = narrow ? widened(level, s.layout.stored_bits) : level;
    }
  }
  if (s.read) s.read->add(VideoSeal::of(image));
  s.hold(false);
  return true;
}

std::vector<double> video_frame_times(const std::string& path) {
  VideoReader reader(path);
  VideoReader::State& s = *reader.state_;
  while (s.read_packet()) av::api().av_packet_unref(s.packet.get());
  std::vector<double> times_s = s.times_s;
  times_s.push_back(s.end_s);
  std::sort(times_s.begin(), times_s.end());
  const double first_s = times_s.front(), tick_s = av_q2d(s.container->streams[s.stream]->time_base);
  for (double& time_s : times_s) time_s -= first_s;
  const int count = count_of(times_s);
  bool rounded = s.format.fps > 0 && 8 * tick_s * s.format.fps < 1;  // else frames that were left out look alike
  for (int n = 0; n < count; ++n) rounded = rounded && std::abs(times_s[n] - n / s.format.fps) < 1.5 * tick_s;
  for (int n = 0; n < count && rounded; ++n) times_s[n] = n / s.format.fps;
  return times_s;
}

}  // namespace vam::io
