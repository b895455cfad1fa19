// SPDX-License-Identifier: GPL-3.0-or-later
// libtiff on bytes in memory: single images, and pages as numbers.
#include "io/image/tiff_pages.hpp"

#include <tiffio.h>

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <memory>
#include <stdexcept>
#include <utility>
#include <vector>

#include "base/error.hpp"
#include "base/index.hpp"
#include "io/image/image_file.hpp"
#include "io/image/private/decoders.hpp"

namespace vam::io {

namespace {

struct TiffMemory {
  std::string bytes;
  std::size_t at = 0;
};

using Tiff = std::unique_ptr<TIFF, void (*)(TIFF*)>;

template <class Value = std::uint16_t>
Value tiff_field(TIFF* tiff, std::uint32_t tag) {
  Value value{};
  TIFFGetFieldDefaulted(tiff, tag, &value);
  return value;
}

/// Rows from the top, columns from the left, as it is without a statement.
bool is_upright(TIFF* tiff) {
  const auto orientation = tiff_field(tiff, TIFFTAG_ORIENTATION);
  return orientation == 0 || orientation == ORIENTATION_TOPLEFT;
}

/// Upright, or only mirrored or turned by 180 degrees, which libtiff undoes in images of 8 bits.
bool has_rows(TIFF* tiff) { return tiff_field(tiff, TIFFTAG_ORIENTATION) <= ORIENTATION_BOTLEFT; }

TiffMemory& memory(thandle_t handle) { return *static_cast<TiffMemory*>(handle); }

tmsize_t read(thandle_t handle, void* to, tmsize_t size) {
  TiffMemory& file = memory(handle);
  const std::size_t left = file.bytes.size() - std::min(file.at, file.bytes.size());
  const std::size_t count = std::min(static_cast<std::size_t>(size), left);
  if (count > 0) std::memcpy(to, file.bytes.data() + file.at, count);
  file.at += count;
  return static_cast<tmsize_t>(count);
}

tmsize_t write(thandle_t /*handle*/, void* /*from*/, tmsize_t /*size*/) { return 0; }

toff_t seek(thandle_t handle, toff_t offset, int whence) {
  TiffMemory& file = memory(handle);
  const toff_t from = whence == SEEK_SET ? 0 : whence == SEEK_CUR ? file.at : file.bytes.size();
  file.at = from + offset;
  return file.at;
}

int close(thandle_t /*handle*/) { return 0; }

toff_t size(thandle_t handle) { return memory(handle).bytes.size(); }

/// Reads; `file` must outlive it. Null where libtiff finds no TIFF. It prints nothing.
Tiff open_tiff(TiffMemory& file) {
  TIFFSetErrorHandler(nullptr);
  TIFFSetWarningHandler(nullptr);
  return {TIFFClientOpen("", "rm", &file, read, write, seek, close, size, nullptr, nullptr), TIFFClose};
}

/// What all pages must have in common.
struct PageLayout {
  std::uint32_t columns = 0;
  std::uint32_t rows = 0;
  std::uint16_t bits = 0;
  std::uint16_t format = 0;
  bool operator==(const PageLayout&) const = default;
};

PageLayout layout_of(TIFF* tiff) {
  return {tiff_field<std::uint32_t>(tiff, TIFFTAG_IMAGEWIDTH), tiff_field<std::uint32_t>(tiff, TIFFTAG_IMAGELENGTH),
          tiff_field(tiff, TIFFTAG_BITSPERSAMPLE), tiff_field(tiff, TIFFTAG_SAMPLEFORMAT)};
}

bool is_plain(TIFF* tiff) {
  return TIFFIsTiled(tiff) == 0 && tiff_field(tiff, TIFFTAG_SAMPLESPERPIXEL) == 1 &&
         tiff_field(tiff, TIFFTAG_PHOTOMETRIC) == PHOTOMETRIC_MINISBLACK;
}

class PageReader {
 public:
  explicit PageReader(std::string bytes) : file{std::move(bytes)} {
    if (!tiff) fail("is a truncated or damaged TIFF");
    constexpr std::uint32_t most_side = 1 << 16;
    layout = layout_of(tiff.get());
    const bool known = layout.format == SAMPLEFORMAT_UINT || layout.format == SAMPLEFORMAT_INT ||
                       (layout.format == SAMPLEFORMAT_IEEEFP && layout.bits >= 16);
    const bool whole = layout.bits == 8 || layout.bits == 16 || layout.bits == 32 || layout.bits == 64;
    if (!known || !whole) {
      fail("has values of " + std::to_string(layout.bits) + " bits and sample format " + std::to_string(layout.format) +
           "; grey whole numbers of 8 to 64 bits and floats of 16 to 64 are read");
    }
    if (layout.columns == 0 || layout.rows == 0 || layout.columns > most_side || layout.rows > most_side) {
      fail("has pages of " + std::to_string(layout.columns) + " x " + std::to_string(layout.rows) +
           " values; up to 65536 along an axis are read");
    }
    count = TIFFNumberOfDirectories(tiff.get());
    // Pages are counted as far as they are found; the last of them names none that follows.
    const bool found = count > 0 && TIFFSetDirectory(tiff.get(), static_cast<tdir_t>(count - 1)) != 0;
    if (found && TIFFLastDirectory(tiff.get()) == 0) fail("is cut off after page " + std::to_string(count));
    if (!found || TIFFSetDirectory(tiff.get(), 0) == 0) fail("is a truncated or damaged TIFF");
    row.resize(std::size_t{layout.columns} * layout.bits / 8);
    used = row.size();
    require_page();
  }

  [[nodiscard]] TiffPages about() const {
    const bool whole = layout.format != SAMPLEFORMAT_IEEEFP;
    const char kind = whole ? (layout.format == SAMPLEFORMAT_INT ? 'i' : 'u') : 'f';
    return {count, layout.rows, layout.columns, kind, layout.bits / 8};
  }

  std::size_t read(char* to, std::size_t size) {
    std::size_t done = 0;
    while (done < size && (used < row.size() || next_row())) {
      const std::size_t step = std::min(size - done, row.size() - used);
      std::memcpy(to + done, row.data() + used, step);
      used += step;
      done += step;
    }
    return done;
  }

 private:
  [[noreturn]] static void fail(const std::string& why) { throw std::runtime_error(why); }

  void require_page() {
    if (!(layout_of(tiff.get()) == layout)) {
      fail("page " + std::to_string(page) + " differs from page 0 in size or type; save pages of one kind");
    }
    if (!is_plain(tiff.get())) {
      fail("page " + std::to_string(page) + " is not grey in strips, 0 black; convert it, as by tiffcp -s");
    }
    if (!is_upright(tiff.get())) {
      fail("page " + std::to_string(page) +
           " states that it is turned or mirrored; turn it, as by convert -auto-orient");
    }
    if (static_cast<std::size_t>(TIFFScanlineSize(tiff.get())) != row.size()) {
      fail("page " + std::to_string(page) + " is damaged");
    }
  }

  bool next_row() {
    if (page == count) return false;
    if (line == layout.rows) {
      if (++page == count) return false;
      if (TIFFReadDirectory(tiff.get()) == 0) fail("is cut off after " + std::to_string(page) + " pages");
      require_page();
      line = 0;
    }
    if (TIFFReadScanline(tiff.get(), row.data(), line) < 0) {
      fail("row " + std::to_string(line) + " of page " + std::to_string(page) + " is truncated or damaged");
    }
    ++line;
    used = 0;
    return true;
  }

  TiffMemory file;
  Tiff tiff = open_tiff(file);
  PageLayout layout;
  std::uint32_t count = 0;
  std::uint32_t page = 0;
  std::uint32_t line = 0;
  std::vector<char> row;
  std::size_t used = 0;  // of the row; all of it, also where none is read yet
};

}  // namespace

std::function<std::size_t(void*, std::size_t)> open_tiff_pages(std::string bytes, TiffPages& about) {
  const auto reader = std::make_shared<PageReader>(std::move(bytes));
  about = reader->about();
  return [reader](void* to, std::size_t size) { return reader->read(static_cast<char*>(to), size); };
}

namespace {

constexpr std::uint16_t most_samples = 8;  // a pixel: colours, transparency and what else a camera adds

[[noreturn]] void refuse(const std::string& name, const std::string& why) {
  throw Error{Fault::data, name + ": cannot be decoded as 8 or 16 grey bits; " + why};
}

/// 16 bits a sample, grey or colours, in strips.
void decode_wide(TIFF* tiff, const std::string& name, GreyImage& image) {
  const auto samples = tiff_field(tiff, TIFFTAG_SAMPLESPERPIXEL);
  const auto photometric = tiff_field(tiff, TIFFTAG_PHOTOMETRIC);
  const bool colours = photometric == PHOTOMETRIC_RGB && samples >= 3;
  const bool grey = photometric == PHOTOMETRIC_MINISBLACK || photometric == PHOTOMETRIC_MINISWHITE;
  if (!(colours || grey) || tiff_field(tiff, TIFFTAG_SAMPLEFORMAT) != SAMPLEFORMAT_UINT || TIFFIsTiled(tiff) != 0 ||
      (samples > 1 && tiff_field(tiff, TIFFTAG_PLANARCONFIG) != PLANARCONFIG_CONTIG)) {
    refuse(name, "16-bit TIFF is read as grey or RGB of whole numbers in strips; convert it first");
  }
  std::vector<std::uint16_t> row(static_cast<std::size_t>(TIFFScanlineSize(tiff)) / 2);
  for (int y = 0; y < image.height; ++y) {
    if (TIFFReadScanline(tiff, row.data(), static_cast<std::uint32_t>(y)) < 0)
      refuse(name, "it is truncated or damaged");
    for (int x = 0; x < image.width; ++x) {
      const std::uint16_t* sample = &row[product(x, samples)];
      const int level = colours ? luma(sample[0], sample[1], sample[2]) : sample[0];
      image(x, y) = static_cast<std::uint16_t>(photometric == PHOTOMETRIC_MINISWHITE ? 65535 - level : level);
    }
  }
}

/// All else that libtiff knows, by way of 8-bit colours.
void decode_narrow(TIFF* tiff, const std::string& name, GreyImage& image) {
  std::vector<std::uint32_t> raster(image.values.size());
  const auto width = static_cast<std::uint32_t>(image.width);
  const auto height = static_cast<std::uint32_t>(image.height);
  if (TIFFReadRGBAImageOriented(tiff, width, height, raster.data(), ORIENTATION_TOPLEFT, 1) == 0) {
    refuse(name, "it is truncated, damaged or of another kind");
  }
  std::transform(raster.begin(), raster.end(), image.values.begin(), [](std::uint32_t p) {
    return static_cast<std::uint16_t>(luma(TIFFGetR(p), TIFFGetG(p), TIFFGetB(p)));
  });
}

}  // namespace

GreyImage decode_tiff(const std::string& bytes, const std::string& name) {
  TiffMemory file{bytes};
  const Tiff tiff = open_tiff(file);
  if (tiff == nullptr) refuse(name, "it is truncated or damaged");
  const auto width = tiff_field<std::uint32_t>(tiff.get(), TIFFTAG_IMAGEWIDTH);
  const auto height = tiff_field<std::uint32_t>(tiff.get(), TIFFTAG_IMAGELENGTH);
  if (width == 0 || height == 0) refuse(name, "it is truncated or damaged");
  if (std::uint64_t{width} * height > max_pixels) throw Error{Fault::data, too_large(name, width, height)};
  const auto bits = tiff_field(tiff.get(), TIFFTAG_BITSPERSAMPLE);
  const auto samples = tiff_field(tiff.get(), TIFFTAG_SAMPLESPERPIXEL);
  if (samples > most_samples) refuse(name, "it has " + std::to_string(samples) + " samples a pixel");
  if (bits > 16) refuse(name, "it has " + std::to_string(bits) + " bits a sample; convert it first");
  if (const int pages = TIFFNumberOfDirectories(tiff.get()); pages > 1) {
    throw Error{Fault::data, name + ": holds " + std::to_string(pages) + " pages, where one image was expected; save " +
                                 "each as a file of its own, as by tiffsplit, or give the file instead of the folder"};
  }
  if (!(bits == 16 ? is_upright : has_rows)(tiff.get())) {
    throw Error{Fault::data, name + ": states that it is turned or mirrored; turn it, as by convert -auto-orient"};
  }
  GreyImage image(static_cast<int>(width), static_cast<int>(height), bits == 16 ? 16 : 8);
  (bits == 16 ? decode_wide : decode_narrow)(tiff.get(), name, image);
  return image;
}

}  // namespace vam::io
