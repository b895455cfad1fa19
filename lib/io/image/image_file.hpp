// SPDX-License-Identifier: GPL-3.0-or-later
// Image files: grey PNG and TIFF in, PNG of any depth out, folders of numbered images.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "base/image.hpp"
#include "base/index.hpp"
#include "base/pixels.hpp"

namespace vam::io {

/// Of full grey, 0...1.
[[nodiscard]] Image fractions(const GreyImage& grey);

/// Reads PNG or TIFF, recognised by their content, as 8 or 16 grey bits; colours become their luma, transparency is
/// ignored, fewer bits are spread over 8. "-" is stdin.
/// Throws Error: no_input, io, data (neither PNG nor TIFF, truncated, damaged).
[[nodiscard]] GreyImage read_image(const std::string& path);

/// Throws Error: data, beginning with `name`, unless the bytes are a whole PNG that read_image() reads.
void require_png(const std::string& bytes, const std::string& name);

/// Text that goes into a PNG beside the pixels (tEXt chunks): keyword to text.
using ImageText = std::map<std::string, std::string>;

/// The bytes of a PNG. Grey of 1, 2, 4, 8 and 16 bits is stored at that depth. 10 bits are stored in 16, spread over
/// the full range as the PNG specification asks (section 12.5: v << 6 | v >> 4) and marked by an sBIT chunk, so that
/// viewers show the right brightness and `>> 6` gives the level back.
[[nodiscard]] std::string encode_png(const GreyImage& image, const ImageText& text = {});
/// dpi: stated in the file (PNG specification, 11.3.5.3); 0: not.
[[nodiscard]] std::string encode_png(const RgbImage& image, const ImageText& text = {}, double dpi = 0);
/// As indices of a palette, of at most 256 colours; throws Fault::bug of more.
[[nodiscard]] std::string encode_indexed_png(const RgbImage& image);

/// Writes a PNG; "-" is stdout. Throws Error: no_output, io.
void write_png(const std::string& path, const GreyImage& image, const ImageText& text = {});
void write_png(const std::string& path, const RgbImage& image, const ImageText& text = {});

/// Of which files a folder is read: grey images (.png, .tif, .tiff), or images of intensity (.exr).
enum class FolderOf { grey, exr };

/// By its name.
[[nodiscard]] bool is_image_file(const std::string& path, FolderOf of = FolderOf::grey);

/// Has the folder EXR images, and no grey ones?
[[nodiscard]] bool is_exr_folder(const std::string& folder);

/// The numbered images of a folder in the order of their numbers, so that 2 comes before 10.
class ImageFolder {
 public:
  /// `gaps`: numbers may be missing. Throws Error: no_input (no such folder), data (no image in it, a number twice, or
  /// missing where it must not).
  explicit ImageFolder(const std::string& folder, bool gaps = false, FolderOf of = FolderOf::grey);

  [[nodiscard]] int count() const { return count_of(paths_); }
  [[nodiscard]] const std::string& path(int index) const { return paths_[index]; }
  /// Where the image stands in the whole series, from 0: its number from the first one's, in steps of the numbers.
  [[nodiscard]] long place(int index) const { return places_[index]; }
  /// The number of the first image.
  [[nodiscard]] long first_number() const { return first_number_; }

  /// Of grey images. Throws as read_image does, and Fault::data when the image has not the size of the first one. One
  /// thread at a time; from the first to the last is fastest.
  [[nodiscard]] GreyImage read(int index);

 private:
  std::vector<std::string> paths_;
  std::vector<long> places_;
  long first_number_ = 0;
  struct Ahead;
  std::shared_ptr<Ahead> ahead_;
  int width_ = 0;
  int height_ = 0;
};

}  // namespace vam::io
