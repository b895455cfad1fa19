#include "io/image/image_file.hpp"

#include <zlib.h>

#include <opencv2/core/utils/logger.hpp>
#include <opencv2/imgcodecs.hpp>

#include "base/error.hpp"
#include "io/stream/input_name.hpp"
#include "io/stream/stream.hpp"

namespace vam::io {

namespace {

std::uint32_t big_endian32(const std::string& bytes, std::size_t at) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < 4; ++i) value = value << 8 | static_cast<std::uint8_t>(bytes[at + i]);
  return value;
}

// libpng talks on stderr and hands out half an image; so the chunks are checked before it sees them.
std::string png_problem(const std::string& bytes) {
  std::size_t at = 8;
  while (at + 12 <= bytes.size()) {
    const std::size_t size = big_endian32(bytes, at);
    if (size > bytes.size() || at + 12 + size > bytes.size()) break;
    const auto* body = reinterpret_cast<const Bytef*>(bytes.data() + at + 4);
    if (crc32(0, body, static_cast<uInt>(size + 4)) != big_endian32(bytes, at + 8 + size)) {
      return "the PNG is damaged at byte " + std::to_string(at) + " (checksum)";
    }
    if (bytes.compare(at + 4, 4, "IEND") == 0) return "";
    at += 12 + size;
  }
  return "the PNG is truncated after " + std::to_string(bytes.size()) + " bytes";
}

bool is_tiff(const std::string& bytes) {
  using namespace std::string_literals;
  return bytes.starts_with("II*\0"s) || bytes.starts_with("MM\0*"s);
}

void check_magic(const std::string& bytes, const std::string& name) {
  if (bytes.starts_with("\x89PNG\r\n\x1a\n")) {
    if (const std::string problem = png_problem(bytes); !problem.empty())
      throw Error{Fault::data, name + ": " + problem};
  } else if (!is_tiff(bytes)) {
    throw Error{Fault::data, name + ": neither PNG nor TIFF; convert it first"};
  }
}

cv::Mat decode(const std::string& bytes, const std::string& name) {
  cv::utils::logging::setLogLevel(cv::utils::logging::LOG_LEVEL_SILENT);
  try {
    const cv::Mat data(1, static_cast<int>(bytes.size()), CV_8U, const_cast<char*>(bytes.data()));
    cv::Mat pixels = cv::imdecode(data, cv::IMREAD_GRAYSCALE | cv::IMREAD_ANYDEPTH);
    if (!pixels.empty() && (pixels.depth() == CV_8U || pixels.depth() == CV_16U)) return pixels;
  } catch (const cv::Exception& problem) {
    throw Error{Fault::data, name + ": cannot be decoded: " + problem.err};
  }
  throw Error{Fault::data,
              name + ": cannot be decoded as 8 or 16 grey bits; it is truncated, damaged or of another kind"};
}

}  // namespace

GreyImage read_image(const std::string& path) {
  const std::string bytes = read_all(path, Content::binary, std::uint64_t{1} << 30);
  const std::string name = input_name(path);
  check_magic(bytes, name);
  const cv::Mat pixels = decode(bytes, name);
  GreyImage image(pixels.cols, pixels.rows, pixels.depth() == CV_8U ? 8 : 16);
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      image(x, y) = image.bits == 8 ? pixels.at<std::uint8_t>(y, x) : pixels.at<std::uint16_t>(y, x);
    }
  }
  return image;
}

void write_tiff(const std::string& path, const GreyImage& image) {
  const bool wide = image.bits > 8;
  cv::Mat pixels(image.height, image.width, wide ? CV_16U : CV_8U);
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const int level = image(x, y);
      if (wide) {
        pixels.at<std::uint16_t>(y, x) = static_cast<std::uint16_t>(image.bits == 10 ? level << 6 | level >> 4 : level);
      } else {
        pixels.at<std::uint8_t>(y, x) = static_cast<std::uint8_t>(level * 255 / image.full());
      }
    }
  }
  std::vector<unsigned char> bytes;
  if (!cv::imencode(".tiff", pixels, bytes)) throw Error{Fault::bug, path + ": the TIFF encoder failed"};
  OutputFile file(path);
  file.write(bytes.data(), bytes.size());
  file.commit();
}

}  // namespace vam::io
