// SPDX-License-Identifier: GPL-3.0-or-later
// libpng leaves by longjmp where an image is damaged: what stands between setjmp and its calls owns nothing.
#include <png.h>

#include <bit>
#include <csetjmp>
#include <cstdint>
#include <cstring>
#include <vector>

#include "base/error.hpp"
#include "io/image/private/decoders.hpp"

namespace vam::io {

namespace {

constexpr std::uint64_t most_pixels_a_byte = std::uint64_t{8} * 1032;  // of 1 bit; deflate makes a byte of at most 1032

struct Source {
  const char* at;
  std::size_t left;
  char problem[120];
  std::size_t allowed = SIZE_MAX;  // bytes until the next row
};

void read(png_structp png, png_bytep to, std::size_t size) {
  auto& source = *static_cast<Source*>(png_get_io_ptr(png));
  if (size > source.left) png_error(png, "it is truncated");
  if (size > source.allowed) png_error(png, "IDAT: Too much image data");  // as libpng says when it has unpacked it all
  std::memcpy(to, source.at, size);
  source.at += size;
  source.left -= size;
  source.allowed -= size;
}

[[noreturn]] void fail(png_structp png, png_const_charp why) {
  auto& source = *static_cast<Source*>(png_get_error_ptr(png));
  std::strncpy(source.problem, why, sizeof source.problem - 1);
  png_longjmp(png, 1);
}

// What stands in the way of other chunks than those of the pixels does no harm.
void judge(png_structp png, png_const_charp why) {
  if (std::strncmp(why, "IDAT", 4) == 0) png_error(png, why);
}

class PngReader {
 public:
  explicit PngReader(Source& source)
      : source_(source),
        png_(png_create_read_struct(PNG_LIBPNG_VER_STRING, &source, fail, judge)),
        info_(png_ != nullptr ? png_create_info_struct(png_) : nullptr) {
    if (info_ == nullptr) throw std::bad_alloc();
    png_set_read_fn(png_, &source, read);
  }
  PngReader(const PngReader&) = delete;
  PngReader& operator=(const PngReader&) = delete;
  ~PngReader() { png_destroy_read_struct(&png_, &info_, nullptr); }

  /// Asks for plain grey; false where the header is damaged.
  bool begin() {
    if (setjmp(png_jmpbuf(png_)) != 0) return false;
    png_set_crc_action(png_, PNG_CRC_ERROR_QUIT, PNG_CRC_ERROR_QUIT);
    png_read_info(png_, info_);
    png_set_expand_gray_1_2_4_to_8(png_);
    png_set_palette_to_rgb(png_);
    png_set_strip_alpha(png_);
    if ((png_get_color_type(png_, info_) & PNG_COLOR_MASK_COLOR) != 0) png_set_rgb_to_gray(png_, 1, 0.299, 0.587);
    if (std::endian::native == std::endian::little) png_set_swap(png_);
    passes_ = png_set_interlace_handling(png_);
    png_read_update_info(png_, info_);
    return true;
  }
  // With the last row libpng unpacks what follows it, without an end: each row may take no more than it can need, in
  // codes of 15 bits, beside the tables of deflate and what libpng reads ahead (8 KiB).
  bool pixels(std::vector<png_bytep>& rows) {
    if (setjmp(png_jmpbuf(png_)) != 0) return false;
    const std::size_t a_row = 2 * row_bytes() + (std::size_t{1} << 15);
    for (int pass = 0; pass < passes_; ++pass) {
      for (png_bytep row : rows) {
        source_.allowed = a_row;
        png_read_row(png_, row, nullptr);
      }
    }
    source_.allowed = SIZE_MAX;
    png_read_end(png_, nullptr);
    return true;
  }
  [[nodiscard]] std::uint32_t width() const { return png_get_image_width(png_, info_); }
  [[nodiscard]] std::uint32_t height() const { return png_get_image_height(png_, info_); }
  [[nodiscard]] int bits() const { return png_get_bit_depth(png_, info_); }
  [[nodiscard]] std::size_t row_bytes() const { return png_get_rowbytes(png_, info_); }

 private:
  Source& source_;
  png_structp png_;
  png_infop info_;
  int passes_ = 1;
};

}  // namespace

GreyImage decode_png(const std::string& bytes, const std::string& name) {
  Source source{bytes.data(), bytes.size(), {}};
  const auto damaged = [&] { return Error{Fault::data, name + ": the PNG is damaged: " + source.problem}; };
  PngReader reader(source);
  if (!reader.begin()) throw damaged();
  if (std::uint64_t{reader.width()} * reader.height() > max_pixels) {
    throw Error{Fault::data, too_large(name, reader.width(), reader.height())};
  }
  if (std::uint64_t{reader.width()} * reader.height() > most_pixels_a_byte * bytes.size()) {
    throw Error{Fault::data, name + ": the PNG is damaged: its " + std::to_string(bytes.size()) +
                                 " bytes cannot hold " + std::to_string(reader.width()) + " x " +
                                 std::to_string(reader.height()) + " pixels"};
  }
  GreyImage image(static_cast<int>(reader.width()), static_cast<int>(reader.height()), reader.bits());
  std::vector<png_byte> pixels(reader.row_bytes() * reader.height());
  std::vector<png_bytep> rows(reader.height());
  for (std::size_t y = 0; y < rows.size(); ++y) rows[y] = pixels.data() + y * reader.row_bytes();
  if (!reader.pixels(rows)) throw damaged();
  if (source.left > 0) {
    throw Error{Fault::data, name + ": has " + std::to_string(source.left) +
                                 " bytes behind the end of its PNG image; it is damaged, or holds several images"};
  }
  if (image.bits == 16) {
    std::memcpy(image.values.data(), pixels.data(), 2 * image.values.size());
  } else {
    image.values.assign(pixels.begin(), pixels.end());
  }
  return image;
}

}  // namespace vam::io
