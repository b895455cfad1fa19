#include "optimize/run/quantise.hpp"

#include <algorithm>
#include <utility>

#include "base/error.hpp"
#include "base/text.hpp"

namespace vam::optimize {

Quantiser::Quantiser(resin::GreyLevels levels, std::optional<double> full_scale, bool error_feedback, Emit emit)
    : levels_(std::move(levels)), full_scale_(full_scale), error_feedback_(error_feedback), emit_(std::move(emit)) {
  if (full_scale_ && !(*full_scale_ > 0))
    throw Error{Fault::usage, "full scale " + format_number(*full_scale_) + " must be above 0"};
}

void Quantiser::add(const Image& image) {
  if (full_scale_) return emit_(quantised(image, static_cast<float>(*full_scale_)));
  held_.push_back(image);
}

void Quantiser::finish() {
  float largest = 0;
  for (const Image& image : held_) {
    for (const float v : image.values) largest = std::max(largest, v);
  }
  for (const Image& image : held_) emit_(largest > 0 ? quantised(image, largest) : image);
  held_.clear();
}

Image Quantiser::quantised(const Image& image, float full_scale) const {
  Image result(image.width, image.height);
  std::vector<float> left(static_cast<std::size_t>(image.width), 0.0F);
  for (int a = 0; a < image.height; ++a) {
    for (int c = 0; c < image.width; ++c) {
      float& error = left[c];
      const float wanted = image(c, a) / full_scale + (error_feedback_ ? error : 0.0F);
      const float given = levels_.intensity(levels_.level(wanted));
      // A projector that cannot show a value at all (darker than its black, brighter than white) must not save up.
      error = std::clamp(wanted - given, -0.5F, 0.5F);
      result(c, a) = given * full_scale;
    }
  }
  return result;
}

}  // namespace vam::optimize
