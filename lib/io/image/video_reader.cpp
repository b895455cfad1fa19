#include <bit>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <optional>

#include "io/image/private/av_handles.hpp"
#include "io/image/private/video.hpp"

namespace vam::io {

namespace {

int bits_of(int pixel_format) {
  switch (pixel_format) {
    case AV_PIX_FMT_GRAY8:
    case AV_PIX_FMT_YUV420P:
    case AV_PIX_FMT_YUVJ420P:
      return 8;  // of the luma plane
    case AV_PIX_FMT_GRAY10LE:
      return 10;
    case AV_PIX_FMT_GRAY16LE:
      return 16;
    default:
      return 0;
  }
}

// An EBML size (RFC 8794 section 4): the leading zeros of the first byte tell how many bytes follow. Empty where it is
// cut, or "unknown", as in a stream.
std::optional<std::uint64_t> ebml_size(std::istream& in) {
  const int first = in.get();
  if (first <= 0) return std::nullopt;
  const int following = std::countl_zero(static_cast<std::uint8_t>(first));
  std::uint64_t value = static_cast<std::uint64_t>(first) & (0x7FU >> following);
  for (int i = 0; i < following; ++i) value = value << 8 | static_cast<std::uint8_t>(in.get());
  const std::uint64_t unknown = (std::uint64_t{1} << (7 * (following + 1))) - 1;
  return in && value != unknown ? std::optional(value) : std::nullopt;
}

// libavformat takes the end of a cut Matroska file for the end of the film; the segment's size knows better.
void refuse_cut_matroska(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  const auto identifier = [&] {
    std::string four(4, '\0');
    in.read(four.data(), 4);
    return four;
  };
  if (identifier() != "\x1a\x45\xdf\xa3") return;
  if (const auto head = ebml_size(in)) in.seekg(static_cast<std::streamoff>(*head), std::ios::cur);
  if (identifier() != "\x18\x53\x80\x67") throw Error{Fault::data, path + ": the video is truncated in its head"};
  const auto size = ebml_size(in);
  if (!size) return;
  const std::uint64_t whole = static_cast<std::uint64_t>(in.tellg()) + *size;
  const std::uint64_t there = std::filesystem::file_size(path);
  if (there < whole) {
    throw Error{Fault::data, path + ": the video is truncated: " + std::to_string(there) + " of " +
                                 std::to_string(whole) + " bytes"};
  }
}

}  // namespace

struct VideoReader::State {
  std::string path;
  VideoFormat format;
  AVFormatContext* container = nullptr;
  int stream = -1;
  av::Codec codec;
  av::AvFrame frame{av_frame_alloc()};
  av::Packet packet{av_packet_alloc()};

  ~State() { avformat_close_input(&container); }

  int check(int status, const char* what) const { return av::check(status, Fault::data, path, what); }

  void open() {
    av::check(avformat_open_input(&container, path.c_str(), nullptr, nullptr), Fault::data, path, "opening the video");
    check(avformat_find_stream_info(container, nullptr), "reading the video");
    const AVCodec* decoder = nullptr;
    stream = check(av_find_best_stream(container, AVMEDIA_TYPE_VIDEO, -1, -1, &decoder, 0), "finding a video stream");
    const AVStream& found = *container->streams[stream];
    codec.reset(avcodec_alloc_context3(decoder));
    check(avcodec_parameters_to_context(codec.get(), found.codecpar), "video decoder");
    check(avcodec_open2(codec.get(), decoder, nullptr), "video decoder");
    format = {codec->width, codec->height, bits_of(codec->pix_fmt), av_q2d(found.avg_frame_rate), ""};
    if (format.bits == 0) throw Error{Fault::data, path + ": not a grey video of 8, 10 or 16 bits"};
    if (const AVDictionaryEntry* entry = av_dict_get(container->metadata, "comment", nullptr, 0))
      format.comment = entry->value;
  }

  // The next packet of the stream; false at the end.
  bool read_packet() {
    int status = av_read_frame(container, packet.get());
    while (status >= 0 && packet->stream_index != stream) {
      av_packet_unref(packet.get());
      status = av_read_frame(container, packet.get());
    }
    if (status != AVERROR_EOF) check(status, "reading the video");
    return status >= 0;
  }

  // Feeds packets until the decoder has a frame; false at the end.
  bool decode() {
    for (;;) {
      const int status = avcodec_receive_frame(codec.get(), frame.get());
      if (status == AVERROR_EOF) return false;
      if (status != AVERROR(EAGAIN)) {
        check(status, "decoding the video");
        if (frame->decode_error_flags != 0) throw Error{Fault::data, path + ": a frame is damaged"};
        return true;
      }
      const bool more = read_packet();
      check(avcodec_send_packet(codec.get(), more ? packet.get() : nullptr), "decoding the video");
      av_packet_unref(packet.get());
    }
  }
};

VideoReader::VideoReader(const std::string& path) : state_(std::make_unique<State>()) {
  if (!std::filesystem::exists(path)) throw Error{Fault::no_input, path + ": no such file"};
  refuse_cut_matroska(path);
  av_log_set_level(AV_LOG_QUIET);
  state_->path = path;
  state_->open();
}

VideoReader::~VideoReader() = default;

const VideoFormat& VideoReader::format() const { return state_->format; }

bool VideoReader::next(GreyImage& image) {
  State& s = *state_;
  if (!s.decode()) return false;
  image = GreyImage(s.frame->width, s.frame->height, s.format.bits);
  for (int y = 0; y < image.height; ++y) {
    const std::uint8_t* row = s.frame->data[0] + static_cast<std::ptrdiff_t>(y) * s.frame->linesize[0];
    for (int x = 0; x < image.width; ++x) {
      std::uint16_t level = row[x];
      if (image.bits > 8) std::memcpy(&level, row + static_cast<std::ptrdiff_t>(2) * x, sizeof level);
      image(x, y) = level;
    }
  }
  return true;
}

int count_video_frames(const std::string& path) {
  VideoReader reader(path);
  int count = 0;
  for (; reader.state_->read_packet(); ++count) av_packet_unref(reader.state_->packet.get());
  return count;
}

}  // namespace vam::io
