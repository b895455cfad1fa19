// SPDX-License-Identifier: GPL-3.0-or-later
#include "vam-convert/images.hpp"

#include "base/error.hpp"
#include "io/image/any_frames.hpp"

namespace vam::convert_tool {

namespace {

void scale(Image& image, const std::optional<double>& full_scale) {
  if (!full_scale) return;
  const auto factor = static_cast<float>(1 / *full_scale);
  for (float& value : image.values) value *= factor;
}

class Array : public Images {
 public:
  Array(const Options& options, const std::string& letters)
      : reader_(options.input, {options.array, axes_of(options, letters)}), full_scale_(options.full_scale) {}
  [[nodiscard]] io::ArraySize size() const override { return reader_.size(); }
  [[nodiscard]] bool are_frames() const override { return false; }
  [[nodiscard]] double voxel_mm() const override { return reader_.voxel_mm(); }
  bool next(Image& image) override {
    if (!reader_.next(image)) return false;
    scale(image, full_scale_);
    return true;
  }

 private:
  io::ArrayReader reader_;
  std::optional<double> full_scale_;
};

class Frames : public Images {
 public:
  Frames(const Options& options, io::FileType type)
      : source_(io::open_images(options.input, type)), full_scale_(options.full_scale) {
    views_.times_s = source_->times_s();
    const model::StackInfo& info = source_->info();
    if (!source_->about().empty()) {
      views_.source = "frames.csv";
      for (const model::ImageInfo& about : source_->about()) views_.angles_deg.push_back(about.angle_deg);
    } else if (info.angle_step_deg != 0) {
      views_.source = "vam:angle_step_deg";
      for (int n = 0; n < info.count; ++n) views_.angles_deg.push_back(n * info.angle_step_deg);
    }
  }
  [[nodiscard]] io::ArraySize size() const override {
    return {source_->info().count, source_->info().height, source_->info().width};
  }
  [[nodiscard]] bool are_frames() const override { return true; }
  [[nodiscard]] model::StackInfo stated() const override { return source_->info(); }
  [[nodiscard]] bool are_grey() const override { return source_->is_grey(); }
  [[nodiscard]] StatedViews views() const override { return views_; }
  bool next(Image& image) override {
    model::ImageInfo about;
    if (!source_->next(image, about)) return false;
    scale(image, full_scale_);
    return true;
  }

 private:
  std::unique_ptr<io::ImageSource> source_;
  StatedViews views_;
  std::optional<double> full_scale_;
};

}  // namespace

std::unique_ptr<Images> open_source(const Options& options, std::optional<io::FileType> type,
                                    const std::string& letters) {
  if (!type) return std::make_unique<Array>(options, letters);
  return std::make_unique<Frames>(options, *type);
}

}  // namespace vam::convert_tool
