// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <vector>

#include "base/error.hpp"
#include "base/index.hpp"
#include "io/image/image_file.hpp"
#include "io/image/private/decoders.hpp"
#include "io/image/private/tiff_memory.hpp"

namespace vam::io {

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
