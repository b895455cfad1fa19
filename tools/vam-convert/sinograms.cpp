// SPDX-License-Identifier: GPL-3.0-or-later
#include "vam-convert/sinograms.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/index.hpp"
#include "optics/projector_frames.hpp"
#include "session/printer.hpp"

namespace vam::convert_tool {

struct Slices::Lit {
  int first = 0;
  std::vector<float> values;
};

namespace {

/// Intensity of every 16-bit level; nothing where the response is not known, and taken to be linear.
std::vector<float> intensities(const Options& options, const model::Printer& printer) {
  std::vector<float> table;
  if (!options.in_vial() || printer.projector.response.empty()) return table;
  const resin::Response response = session::response_of(printer.projector);
  for (int level = 0; level < 65536; ++level) table.push_back(static_cast<float>(response.intensity(level / 65535.0)));
  return table;
}

void respond(const std::vector<float>& table, Image& image) {
  if (table.empty()) return;
  for (float& value : image.values) {
    value = table[std::lround(65535 * std::clamp(value, 0.0F, 1.0F))];
  }
}

/// The image turned by 90 degrees, as one sees it: row 0 is at the top.
Image quarter_turned(const Image& image, bool clockwise) {
  Image turned(image.height, image.width);
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      if (clockwise) turned(image.height - 1 - y, x) = image(x, y);
      if (!clockwise) turned(y, image.width - 1 - x) = image(x, y);
    }
  }
  return turned;
}

/// As it was before it was turned for the projector.
void upright(Image& frame, const std::string& orientation) {
  if (orientation == "rotate-90") frame = quarter_turned(frame, false);
  if (orientation == "rotate-270") frame = quarter_turned(frame, true);
  optics::orient(frame, orientation);
}

}  // namespace

Slices::Slices(std::unique_ptr<Images> images, const Options& options, const model::Printer& printer)
    : images_(std::move(images)), size_(images_->size()), lit_columns_(0, size_.columns - 1) {
  if (images_->are_frames()) collect(options, printer);
}

Slices::~Slices() = default;

io::ArraySize Slices::size() const { return size_; }

void Slices::collect(const Options& options, const model::Printer& printer) {
  const std::vector<float> table = images_->are_grey() ? intensities(options, printer) : std::vector<float>{};
  std::pair<int, int> lit{65536, 0};
  Image frame;
  while (images_->next(frame)) {
    peak_ = std::max(peak_, *std::max_element(frame.values.begin(), frame.values.end()));
    upright(frame, options.orientation);
    respond(table, frame);
    for (int y = frame.height - 1; y >= 0; --y) {
      const float* begin = frame.row(y);
      const float* end = begin + frame.width;
      const float* first = std::find_if(begin, end, [](float value) { return value != 0; });
      while (end > first && end[-1] == 0) --end;
      if (end > first)
        lit = {std::min(lit.first, static_cast<int>(first - begin)),
               std::max(lit.second, static_cast<int>(end - begin) - 1)};
      lit_.push_back({static_cast<int>(first - begin), {first, end}});
    }
  }
  size_ = {frame.height, count_of(lit_) / frame.height, frame.width};
  if (lit.first <= lit.second) lit_columns_ = lit;
}

bool Slices::next(Image& slice) {
  if (lit_.empty()) return images_->next(slice);
  if (done_ == size_.images) return false;
  slice = Image(size_.columns, size_.rows);
  for (int a = 0; a < size_.rows; ++a) {
    const Lit& lit = lit_[product(a, size_.images) + done_];
    std::copy(lit.values.begin(), lit.values.end(), slice.row(a) + lit.first);
  }
  ++done_;
  return true;
}

}  // namespace vam::convert_tool
