// SPDX-License-Identifier: GPL-3.0-or-later
#include "optimize/run/quantise.hpp"

#include <algorithm>
#include <utility>

#include "base/error.hpp"
#include "base/text/text.hpp"

namespace vam::optimize {

Quantiser::Quantiser(resin::GreyLevels levels, std::optional<double> full_scale, bool error_feedback, Emit emit)
    : levels_(std::move(levels)), full_scale_(full_scale), emit_(std::move(emit)) {
  if (error_feedback) dither_.emplace(levels_, 1);
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
  for (Image& image : held_) {
    emit_(largest > 0 ? quantised(image, largest) : image);
    image = {};
  }
  held_.clear();
}

Image Quantiser::quantised(const Image& image, float full_scale) const {
  Image result = image;
  for (float& value : result.values) value /= full_scale;
  if (dither_) {
    result = resin::dithered(result, *dither_);
  } else {
    for (float& value : result.values) value = levels_.intensity(levels_.level(value));
  }
  for (float& value : result.values) value *= full_scale;
  return result;
}

}  // namespace vam::optimize
