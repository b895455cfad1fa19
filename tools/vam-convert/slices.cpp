// SPDX-License-Identifier: GPL-3.0-or-later
#include "vam-convert/slices.hpp"

#include <algorithm>
#include <cmath>

#include "base/error.hpp"
#include "base/index.hpp"
#include "base/text/image_size.hpp"
#include "io/stream/stream.hpp"
#include "optics/projector_frames.hpp"
#include "session/printer.hpp"

namespace vam::convert_tool {

struct Slices::Lit {
  int first = 0;
  std::vector<float> values;
};

namespace {

class ArraySource : public io::ImageSource {
 public:
  ArraySource(const Options& options, const std::string& letters) : reader_(options.input, array_of(options, letters)) {
    const io::ArraySize size = reader_.size();
    info_.count = size.images;
    info_.height = size.rows;
    info_.width = size.columns;
    info_.pixel_mm = reader_.voxel_mm();
  }
  [[nodiscard]] const model::StackInfo& info() const override { return info_; }
  bool next(Image& image, model::ImageInfo&) override { return reader_.next(image); }
  [[nodiscard]] bool has_pages() const { return reader_.has_pages(); }

 private:
  io::ArrayReader reader_;
  model::StackInfo info_;
};

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

/// The light of pixels that are not even.
void shine(const Image& flat, Image& frame, const std::string& name) {
  if (flat.values.empty()) return;
  if (frame.width != flat.width || frame.height != flat.height) {
    throw Error{Fault::data, name + ": its frames have " + size_text(frame) + " pixels, projector.flat " +
                                 size_text(flat) +
                                 "; name the printer that showed them, or set projector.flat= to none"};
  }
  for (std::size_t i = 0; i < frame.size(); ++i) frame.values[i] *= flat.values[i];
}

/// As it was before it was turned for the projector.
void upright(Image& frame, const std::string& orientation) {
  if (orientation == "rotate-90" || orientation == "rotate-270") {
    Image back(frame.height, frame.width);
    for (int y = 0; y < frame.height; ++y) {
      for (int x = 0; x < frame.width; ++x) back(y, frame.width - 1 - x) = frame(x, y);
    }
    frame = std::move(back);
  }
  optics::orient(frame, orientation == "rotate-270" ? "rotate-180" : orientation);
}

}  // namespace

Slices::Slices(const Options& options, std::optional<io::FileType> type, const std::string& letters)
    : name_(io::input_name(options.input)), full_scale_(options.full_scale.value_or(1)), frames_(type.has_value()) {
  if (type) source_ = io::open_images(options.input, *type);
  if (!type) {
    auto array = std::make_unique<ArraySource>(options, letters);
    pages_ = array->has_pages() && options.axes.empty() && options.from == "none" && letters == "zyx";
    source_ = std::move(array);
  }
  const model::StackInfo& info = source_->info();
  size_ = {info.count, info.height, info.width};
  lit_columns_ = {0, info.width - 1};
}

Slices::~Slices() = default;

bool Slices::take(Image& image) {
  model::ImageInfo about;
  const int count = source_->info().count;
  if (!source_->next(image, about)) {
    if (taken_ >= count) return false;
    throw Error{Fault::data, name_ + ": ends after " + std::to_string(taken_) + " of " + std::to_string(count) +
                                 " images; it is incomplete"};
  }
  ++taken_;
  const auto factor = static_cast<float>(1 / full_scale_);
  for (float& value : image.values) value *= factor;
  return true;
}

void Slices::collect(const Options& options, const model::Printer& printer) {
  const std::vector<float> table = source_->is_grey() ? intensities(options, printer) : std::vector<float>{};
  const Image flat = options.in_vial() ? session::flat_of(printer.projector) : Image{};
  std::pair<int, int> lit{65536, 0};
  Image frame;
  while (take(frame)) {
    peak_ = std::max(peak_, *std::max_element(frame.values.begin(), frame.values.end()));
    upright(frame, options.orientation);
    respond(table, frame);
    shine(flat, frame, name_);
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
  if (lit_.empty()) {
    if (!take(slice)) return false;
    if (frames_ || pages_) optics::orient(slice, "flip-rows");  // voxels begin at the least y
    return true;
  }
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
