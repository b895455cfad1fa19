// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <exception>
#include <functional>
#include <optional>
#include <vector>

#include "base/compute/parallel.hpp"
#include "base/text/format_version.hpp"
#include "base/text/text.hpp"
#include "io/image/private/av_library.hpp"
#include "io/image/private/ffv1.hpp"
#include "io/image/private/matroska.hpp"
#include "io/image/video.hpp"
#include "io/stream/stream.hpp"

namespace vam::io {

namespace {

constexpr int buffer_bytes = 1 << 16;

AVPixelFormat pixel_format(bool lossless, int bits) {
  if (!lossless) return AV_PIX_FMT_YUV420P;
  if (bits > 10) return AV_PIX_FMT_GRAY16LE;
  return bits > 8 ? AV_PIX_FMT_GRAY10LE : AV_PIX_FMT_GRAY8;
}

// Bytes on their way from libavformat to an OutputFile, which alone knows temporary names. libavformat is C, so an
// exception waits here until control is back.
struct EncoderSink {
  OutputFile file;
  std::uint64_t position = 0;
  std::string head;  // the first bytes as they are now
  std::exception_ptr failure;

  explicit EncoderSink(const std::string& path) : file(path) {}

  static constexpr std::size_t head_bytes = 256;  // where a container tells its size

  void put(const std::uint8_t* bytes, std::size_t size) {
    if (position < head_bytes) {
      const auto at = static_cast<std::size_t>(position), count = std::min(size, head_bytes - at);
      head.resize(std::max(head.size(), at + count));
      std::copy_n(reinterpret_cast<const char*>(bytes), count, head.begin() + static_cast<std::ptrdiff_t>(at));
    }
    const std::uint64_t end = file.position();
    const std::size_t patch =
        position < end ? static_cast<std::size_t>(std::min<std::uint64_t>(size, end - position)) : 0;
    if (patch > 0) file.write_at(position, bytes, patch);
    if (patch < size) file.write(bytes + patch, size - patch);
    position += size;
  }

  static int on_write(void* self, std::uint8_t* bytes, int size) {
    auto& sink = *static_cast<EncoderSink*>(self);
    try {
      sink.put(bytes, size);
      return size;
    } catch (...) {
      sink.failure = std::current_exception();
      return AVERROR(EIO);
    }
  }

  static std::int64_t on_seek(void* self, std::int64_t offset, int whence) {
    auto& sink = *static_cast<EncoderSink*>(self);
    const auto end = static_cast<std::int64_t>(sink.file.position());
    if (whence == AVSEEK_SIZE) return end;
    const std::int64_t base = whence == SEEK_SET   ? 0
                              : whence == SEEK_CUR ? static_cast<std::int64_t>(sink.position)
                                                   : end;
    if (base + offset < 0 || base + offset > end) return AVERROR(EINVAL);
    sink.position = static_cast<std::uint64_t>(base + offset);
    return base + offset;
  }
};

// Each grey level in 0..255.
std::vector<std::uint8_t> stored_bytes(int bits) {
  const int full = (1 << bits) - 1;
  std::vector<std::uint8_t> bytes;
  for (int level = 0; level <= full; ++level) {
    bytes.push_back(static_cast<std::uint8_t>(bits < 8 ? level * 255 / full : level >> (bits - 8)));
  }
  return bytes;
}

std::uint8_t byte_of(double value) { return static_cast<std::uint8_t>(std::clamp(std::lround(value), 0L, 255L)); }

template <class Pixel>
double luma(const Pixel& rgb) {
  return 0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2];
}

std::uint32_t checksum(const std::uint8_t* bytes, std::size_t count) {
  return av::api().av_crc(av::api().av_crc_get_table(AV_CRC_32_IEEE), 0, bytes, count);
}

}  // namespace

struct VideoWriter::State {
  VideoFormat format;
  bool lossless;
  bool wide;                         // levels as they are, in 16 bits
  std::vector<std::uint8_t> stored;  // else each level's byte
  EncoderSink sink;
  AVIOContext* io = nullptr;
  AVFormatContext* container = nullptr;
  AVStream* stream = nullptr;
  av::Codec codec;
  av::AvFrame frame;
  av::Packet packet{av::api().av_packet_alloc()};
  std::int64_t written = 0;
  std::optional<Ffv1Frames> alone;  // frames of which each is encoded by one thread
  std::optional<VideoSeal> seal;    // of a lossless video

  State(const std::string& path, const VideoFormat& wanted)
      : format(wanted),
        lossless(path.ends_with(".mkv")),
        wide(lossless && wanted.bits > 8),
        stored(stored_bytes(wanted.bits)),
        sink(path) {}
  ~State() {
    av::api().avformat_free_context(container);
    if (io != nullptr) av::api().av_freep(&io->buffer);
    av::api().avio_context_free(&io);
  }
  State(const State&) = delete;
  State& operator=(const State&) = delete;

  int check(int status, const char* what) {
    if (sink.failure) std::rethrow_exception(sink.failure);
    return av::check(status, Fault::io, sink.file.name(), what);
  }

  void open_container() {
    check(av::api().avformat_alloc_output_context2(&container, nullptr, lossless ? "matroska" : "mp4", nullptr),
          "video container");
    io = av::api().avio_alloc_context(static_cast<unsigned char*>(av::api().av_malloc(buffer_bytes)), buffer_bytes, 1,
                                      &sink, nullptr, EncoderSink::on_write,
                                      sink.file.is_stream() ? nullptr : EncoderSink::on_seek);
    container->pb = io;
    container->flags |= AVFMT_FLAG_BITEXACT;  // no library version, no random identifiers
    const std::string comment = format.comment + (format.facts.empty() ? "" : "\n" + format.facts);
    av::api().av_dict_set(&container->metadata, "comment", comment.c_str(), 0);
    if (lossless) av::api().av_dict_set(&container->metadata, video_version, FormatKind("video").version().c_str(), 0);
  }

  av::Codec opened_codec(int width, int height) {
    const AVCodec* encoder =
        lossless ? av::api().avcodec_find_encoder(AV_CODEC_ID_FFV1) : av::api().avcodec_find_encoder_by_name("libx264");
    if (encoder == nullptr)
      throw Error{Fault::absent, sink.file.name() + ": this libavcodec has no H.264 encoder (libx264); " +
                                     (format.colour ? "install it" : "write .mkv")};
    av::Codec opened{av::api().avcodec_alloc_context3(encoder)};
    if (format.colour) {
      opened->colorspace = AVCOL_SPC_BT709;
      opened->color_primaries = AVCOL_PRI_BT709;
      opened->color_trc = AVCOL_TRC_BT709;
    }
    opened->width = lossless ? width : width + width % 2;
    opened->height = lossless ? height : height + height % 2;
    opened->pix_fmt = pixel_format(lossless, format.bits);
    opened->color_range = AVCOL_RANGE_JPEG;
    opened->framerate = av::api().av_d2q(format.fps, 1000000);
    opened->time_base = av_inv_q(opened->framerate);
    opened->thread_count = lossless ? threads() : 1;  // x264's bytes depend on it
    opened->thread_type = FF_THREAD_SLICE;            // FFV1's do not: it has the same slices
    opened->flags |= AV_CODEC_FLAG_BITEXACT;
    if ((container->oformat->flags & AVFMT_GLOBALHEADER) != 0) opened->flags |= AV_CODEC_FLAG_GLOBAL_HEADER;
    if (lossless) {
      opened->gop_size = 1;  // every frame stands alone
      av::api().av_opt_set_int(opened.get(), "level", 3, 0);
      // libavcodec 59 loses flat pixels of slices one pixel high or wide, as of frames of 2 x 2.
      opened->slices = std::min(opened->width, opened->height) < 4 ? 1 : 4;
      av::api().av_opt_set_int(opened->priv_data, "slicecrc", 1, 0);
    } else {
      av::api().av_opt_set(opened->priv_data, "preset", "veryfast", 0);
      av::api().av_opt_set(opened->priv_data, "crf", "16", 0);
    }
    check(av::api().avcodec_open2(opened.get(), encoder, nullptr), "video encoder");
    return opened;
  }

  av::AvFrame frame_of(const av::Codec& of) {
    av::AvFrame empty{av::api().av_frame_alloc()};
    empty->format = of->pix_fmt;
    empty->width = of->width;
    empty->height = of->height;
    empty->color_range = of->color_range;
    check(av::api().av_frame_get_buffer(empty.get(), 0), "video frame");
    return empty;
  }

  void open_stream() {
    stream = av::api().avformat_new_stream(container, nullptr);
    stream->time_base = codec->time_base;
    stream->avg_frame_rate = codec->framerate;
    check(av::api().avcodec_parameters_from_context(stream->codecpar, codec.get()), "video stream");
    AVDictionary* options = nullptr;
    // MP4 keeps its index at the end and seeks back; on a pipe it must come in fragments.
    if (!lossless && sink.file.is_stream()) av::api().av_dict_set(&options, "movflags", "frag_keyframe+empty_moov", 0);
    const int status = av::api().avformat_write_header(container, &options);
    av::api().av_dict_free(&options);
    check(status, "video header");
    frame = frame_of(codec);
  }

  // By a small frame, as the encoder takes 148 bytes for each pixel of one.
  void try_alone() {
    if (!lossless || wide) return;
    constexpr int enough = 64;
    const GreyImage trial = Ffv1Frames::trial(std::min(format.width, enough), std::min(format.height, enough));
    const av::Codec encoder = opened_codec(trial.width, trial.height);
    const av::AvFrame tried = frame_of(encoder);
    for (int y = 0; y < trial.height; ++y) {
      const std::uint16_t* from = trial.values.data() + trial.index(0, y);
      std::copy(from, from + trial.width, tried->data[0] + static_cast<std::ptrdiff_t>(y) * tried->linesize[0]);
    }
    check(av::api().avcodec_send_frame(encoder.get(), tried.get()), "video encoding");
    check(av::api().avcodec_receive_packet(encoder.get(), packet.get()), "video encoding");
    alone = Ffv1Frames::like({packet->data, packet->data + packet->size}, trial.width, trial.height, checksum);
    if (alone) alone->resize(format.width, format.height);
    av::api().av_packet_unref(packet.get());
  }

  void put(Bytes& bytes) {
    packet->data = bytes.data();
    packet->size = static_cast<int>(bytes.size());
    packet->flags |= AV_PKT_FLAG_KEY;
    packet->pts = packet->dts = written++;
    put_packet();
  }

  void put_packet() {
    packet->stream_index = 0;
    packet->duration = 1;
    av::api().av_packet_rescale_ts(packet.get(), codec->time_base, stream->time_base);
    check(av::api().av_interleaved_write_frame(container, packet.get()), "writing the video");
  }

  void require_format(const GreyImage& image) const {
    if (image.width == format.width && image.height == format.height && image.bits == format.bits) return;
    throw Error{Fault::bug,
                sink.file.name() + ": frame " + std::to_string(written) + " has another size or depth than the video"};
  }

  /// Lossless: the levels.
  void fill(AVFrame& to, const GreyImage& image) const {
    for (int y = 0; y < image.height; ++y) {
      std::uint8_t* row = to.data[0] + static_cast<std::ptrdiff_t>(y) * to.linesize[0];
      const std::uint16_t* from = image.values.data() + image.index(0, y);
      if (wide) {
        std::memcpy(row, from, sizeof *from * static_cast<std::size_t>(image.width));
      } else {
        std::transform(from, from + image.width, row, [this](std::uint16_t level) { return stored[level]; });
      }
    }
  }

  /// Luma of each pixel, colour differences of two by two [ITU-R BT.709].
  void fill(AVFrame& to, const RgbImage& image) const {
    for (int y = 0; y < to.height; y += 2) {
      for (int x = 0; x < to.width; x += 2) {
        std::array<double, 3> sum{};
        for (int corner = 0; corner < 4; ++corner) {
          const int i = x + corner % 2, j = y + corner / 2;
          const Rgb& pixel = image(std::min(i, image.width - 1), std::min(j, image.height - 1));
          to.data[0][static_cast<std::ptrdiff_t>(j) * to.linesize[0] + i] = byte_of(luma(pixel));
          for (std::size_t c = 0; c < 3; ++c) sum[c] += pixel[c] / 4.0;
        }
        const double mean = luma(sum);
        const auto at = [&](int plane) -> std::uint8_t& {
          return to.data[plane][static_cast<std::ptrdiff_t>(y / 2) * to.linesize[plane] + x / 2];
        };
        at(1) = byte_of(128 + (sum[2] - mean) / 1.8556);
        at(2) = byte_of(128 + (sum[0] - mean) / 1.5748);
      }
    }
  }

  template <class Image>
  void put_frame(const Image& image) {
    check(av::api().av_frame_make_writable(frame.get()), "video frame");
    fill(*frame, image);
    frame->pts = written++;
    send(frame.get());
  }

  [[nodiscard]] RgbImage in_colour(const GreyImage& image) const {
    RgbImage grey(image.width, image.height);
    std::transform(image.values.begin(), image.values.end(), grey.values.begin(), [this](std::uint16_t level) {
      return Rgb{stored[level], stored[level], stored[level]};
    });
    return grey;
  }

  // Of what the frame is decoded to.
  [[nodiscard]] Digest digest(const GreyImage& image) const {
    if (wide || format.bits == 8) return VideoSeal::of(image);
    GreyImage decoded = image;
    for (std::uint16_t& level : decoded.values) level = stored[level];
    return VideoSeal::of(decoded);
  }

  // Behind all parts, where the size of the segment then says so.
  void write_seal() {
    const auto size_at = sink.file.is_stream() ? std::nullopt : segment_size_at(sink.head);
    if (!seal || !size_at) return;
    const std::string element = seal_element(seal->digest());
    sink.file.write(element);
    std::array<char, 8> size{1};  // seven bytes follow
    const std::uint64_t whole = sink.file.position() - (*size_at + size.size());
    for (std::size_t i = 1; i < size.size(); ++i) size[i] = static_cast<char>(whole >> 8 * (size.size() - 1 - i));
    sink.file.write_at(*size_at, size.data(), size.size());
  }

  void send(const AVFrame* next) {
    check(av::api().avcodec_send_frame(codec.get(), next), "video encoding");
    for (;;) {
      const int status = av::api().avcodec_receive_packet(codec.get(), packet.get());
      if (status == AVERROR(EAGAIN) || status == AVERROR_EOF) return;
      check(status, "video encoding");
      put_packet();
    }
  }
};

VideoWriter::VideoWriter(const std::string& path, const VideoFormat& format) {
  if (!path.ends_with(".mkv") && !path.ends_with(".mp4")) {
    throw Error{Fault::usage, path + ": a video ends in .mkv (lossless) or .mp4 (lossy preview)"};
  }
  if (std::min(format.width, format.height) < 2) {  // libavcodec 59 loses them
    throw Error{Fault::usage, path + ": a video has at least 2 x 2 pixels, not " +
                                  size_text(format.width, format.height) + "; write images"};
  }
  av::api().av_log_set_level(AV_LOG_QUIET);
  state_ = std::make_unique<State>(path, format);
  state_->open_container();
  state_->codec = state_->opened_codec(format.width, format.height);
  state_->open_stream();
  state_->try_alone();
  if (state_->lossless) {
    state_->seal.emplace(format.width, format.height, state_->wide ? format.bits : 8, FormatKind("video").version(),
                         format.facts);
  }
}

VideoWriter::~VideoWriter() = default;

void VideoWriter::write(const GreyImage& image) {
  write(1, [&](int) -> const GreyImage& { return image; });
}

void VideoWriter::write(int count, const std::function<const GreyImage&(int)>& image) {
  State& s = *state_;
  for (int i = 0; i < count; ++i) s.require_format(image(i));
  if (s.alone) {
    std::vector<Bytes> packets(static_cast<std::size_t>(count));
    std::vector<Digest> digests(packets.size());
    parallel_for(count, [&](int i) {
      packets[static_cast<std::size_t>(i)] = s.alone->packet(image(i));
      digests[static_cast<std::size_t>(i)] = s.digest(image(i));
    });
    for (Bytes& packet : packets) s.put(packet);
    for (const Digest& digest : digests) s.seal->add(digest);
    return;
  }
  for (int i = 0; i < count; ++i) {
    if (s.lossless) {
      s.put_frame(image(i));
      s.seal->add(s.digest(image(i)));
    } else {
      s.put_frame(s.in_colour(image(i)));
    }
  }
}

void VideoWriter::write(const RgbImage& image) {
  State& s = *state_;
  if (!s.format.colour || image.width != s.format.width || image.height != s.format.height)
    throw Error{Fault::bug, s.sink.file.name() + ": frame " + std::to_string(s.written) + " is not as the video"};
  s.put_frame(image);
}

void VideoWriter::commit() {
  State& s = *state_;
  s.send(nullptr);
  s.check(av::api().av_write_trailer(s.container), "ending the video");
  av::api().avio_flush(s.io);
  s.check(0, "ending the video");
  s.write_seal();
  s.sink.file.commit();
}

}  // namespace vam::io
