// SPDX-License-Identifier: GPL-3.0-or-later
#include "metrology/calibrate/flat.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/error.hpp"
#include "base/stats/range.hpp"
#include "base/text/text.hpp"

namespace vam::metrology {

namespace {

constexpr float dead_below = 0.2F;

double percentile(std::vector<float> values, double part) {
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(part * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

// The mean of the living among the eight neighbours; 1 where all are dead.
float neighbours(const Image& field, int x, int y) {
  double sum = 0;
  int count = 0;
  for (int dy = -1; dy <= 1; ++dy) {
    for (int dx = -1; dx <= 1; ++dx) {
      const int nx = x + dx;
      const int ny = y + dy;
      if (nx < 0 || ny < 0 || nx >= field.width || ny >= field.height || field(nx, ny) < dead_below) continue;
      sum += field(nx, ny);
      ++count;
    }
  }
  return count > 0 ? static_cast<float>(sum / count) : 1.0F;
}

int mend(Image& field) {
  const Image as_seen = field;
  int dead = 0;
  for (int y = 0; y < field.height; ++y) {
    for (int x = 0; x < field.width; ++x) {
      if (as_seen(x, y) >= dead_below) continue;
      field(x, y) = neighbours(as_seen, x, y);
      ++dead;
    }
  }
  return dead;
}

}  // namespace

void FrameMean::add(const Image& frame) {
  if (count_ == 0) {
    width_ = frame.width;
    height_ = frame.height;
    sum_.assign(frame.size(), 0);
    square_.assign(frame.size(), 0);
  }
  if (frame.width != width_ || frame.height != height_) {
    throw Error{Fault::data, "frame " + std::to_string(count_) + " has " + size_text(frame.width, frame.height) +
                                 " pixels, those before " + size_text(width_, height_)};
  }
  for (std::size_t i = 0; i < frame.size(); ++i) {
    const double value = frame.values[i];
    sum_[i] += value;
    square_[i] += value * value;
  }
  ++count_;
}

Image FrameMean::mean() const {
  Image image(width_, height_);
  for (std::size_t i = 0; i < image.size(); ++i) image.values[i] = static_cast<float>(sum_[i] / count_);
  return image;
}

double FrameMean::noise() const {
  double variance = 0;
  for (std::size_t i = 0; i < sum_.size(); ++i) {
    variance += std::max(square_[i] - sum_[i] * sum_[i] / count_, 0.0) / (count_ - 1);
  }
  return std::sqrt(variance / static_cast<double>(sum_.size()));
}

FlatField flat_field(const FrameMean& frames, const Image& dark, double dark_sigma) {
  if (frames.count() < 3) {
    throw Error{Fault::data, "flat: " + std::to_string(frames.count()) + " frames; at least 3 are needed"};
  }
  FlatField flat;
  flat.field = frames.mean();
  if (!dark.values.empty()) {
    if (dark.width != flat.field.width || dark.height != flat.field.height) {
      throw Error{Fault::data, "flat: the dark frame has " + size_text(dark.width, dark.height) +
                                   " pixels, the scene " + size_text(flat.field.width, flat.field.height)};
    }
    for (std::size_t i = 0; i < dark.size(); ++i) flat.field.values[i] -= dark.values[i];
  }
  const double mean = stats::mean_value(flat.field.values);
  const double error = std::hypot(frames.noise() / std::sqrt(frames.count()), dark_sigma);
  if (!(mean > 3 * error)) {
    throw Error{Fault::data, "flat: the scene is dark, " + format_number(mean) + " +- " + format_number(error)};
  }
  flat.level = {mean, error / std::sqrt(static_cast<double>(flat.field.size())), frames.count()};
  for (float& value : flat.field.values) value = static_cast<float>(value / mean);
  flat.dead = mend(flat.field);
  if (flat.dead > 0.01 * static_cast<double>(flat.field.size())) {
    throw Error{Fault::data, "flat: " + std::to_string(flat.dead) + " of " + std::to_string(flat.field.size()) +
                                 " pixels are dark; light the whole field evenly"};
  }
  flat.unevenness = 0.5 * (percentile(flat.field.values, 0.99) - percentile(flat.field.values, 0.01));
  flat.pixel_sigma = error / mean;
  return flat;
}

}  // namespace vam::metrology
