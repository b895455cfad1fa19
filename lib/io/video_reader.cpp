#include <cstring>
#include <filesystem>

#include "io/av_handles.hpp"
#include "io/video.hpp"

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

}  // namespace

struct VideoReader::State {
  std::string path;
  VideoFormat format;
  AVFormatContext* container = nullptr;
  int stream = -1;
  av::Codec codec;
  av::Frame frame{av_frame_alloc()};
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
      int read = av_read_frame(container, packet.get());
      while (read >= 0 && packet->stream_index != stream) {
        av_packet_unref(packet.get());
        read = av_read_frame(container, packet.get());
      }
      if (read < 0 && read != AVERROR_EOF) check(read, "reading the video");
      check(avcodec_send_packet(codec.get(), read < 0 ? nullptr : packet.get()), "decoding the video");
      av_packet_unref(packet.get());
    }
  }
};

VideoReader::VideoReader(const std::string& path) : state_(std::make_unique<State>()) {
  if (!std::filesystem::exists(path)) throw Error{Fault::no_input, path + ": no such file"};
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

}  // namespace vam::io
