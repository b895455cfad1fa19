// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/array/private/array_parser.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "base/error.hpp"
#include "io/stream/finite.hpp"

namespace vam::io::arrays {

namespace {

constexpr std::size_t values_a_pass = 1 << 16;  // values converted at a time
constexpr std::size_t side_by_side = 16;        // images gathered at a time, as their values share cache lines

// Of the array's own axes, in values.
std::array<std::size_t, 3> strides(const Head& head) {
  if (head.fortran) return {1, head.shape[0], head.shape[0] * head.shape[1]};
  return {head.shape[1] * head.shape[2], head.shape[2], 1};
}

}  // namespace

Parser::Parser(const Head& head, Bytes values, std::array<int, 3> axes) : head_(head), bytes_(std::move(values)) {
  const std::array<std::size_t, 3> own = strides(head_);
  for (std::size_t i = 0; i < 3; ++i) {
    size_[i] = head_.shape[axes[i]];
    stride_[i] = own[axes[i]];
  }
  if (size_[1] * size_[2] > most_image) throw std::runtime_error("has images of more than 2^28 values");
  streams_ = stride_[2] == 1 && stride_[1] == size_[2] && (stride_[0] == size_[1] * size_[2] || size_[0] == 1);
}

void Parser::take_floats(float* to, std::size_t count) {
  const auto bytes = static_cast<std::size_t>(head_.bytes);
  raw_.resize(values_a_pass * bytes);
  for (std::size_t done = 0; done < count; done += values_a_pass) {
    const std::size_t step = std::min(values_a_pass, count - done);
    bytes_.take(raw_.data(), step * bytes);
    to_floats(head_, raw_.data(), step, to + done);
  }
}

void Parser::hold_all() {
  all_.resize(head_.values());
  take_floats(all_.data(), all_.size());
  require_end();
}

void Parser::gather() {
  const std::size_t count = std::min(side_by_side, size_[0] - done_);
  some_.assign(count, Image(static_cast<int>(size_[2]), static_cast<int>(size_[1])));
  for (std::size_t r = 0; r < size_[1]; ++r) {
    for (std::size_t c = 0; c < size_[2]; ++c) {
      const float* from = all_.data() + done_ * stride_[0] + r * stride_[1] + c * stride_[2];
      for (std::size_t k = 0; k < count; ++k) some_[k].values[r * size_[2] + c] = from[k * stride_[0]];
    }
  }
}

void Parser::check(const Image& image) const {
  if (all_finite(image.values.data(), image.size())) return;
  const auto bad = std::find_if(image.values.begin(), image.values.end(), [](float v) { return !std::isfinite(v); });
  const auto at = bad - image.values.begin();
  throw std::runtime_error("column " + std::to_string(at % image.width) + ", row " + std::to_string(at / image.width) +
                           " of image " + std::to_string(done_) +
                           " is not a finite number; numpy.nan_to_num() replaces such values");
}

void Parser::require_end() {
  if (bytes_.ended()) return;
  throw std::runtime_error("has bytes behind its " + std::to_string(head_.values()) +
                           " values; it is damaged, or several arrays in one");
}

void Parser::next(Image& image) {
  if (streams_) {
    image = Image(static_cast<int>(size_[2]), static_cast<int>(size_[1]));
    take_floats(image.values.data(), image.size());
    if (done_ + 1 == size_[0]) require_end();
  } else {
    if (done_ == 0) hold_all();
    if (done_ % side_by_side == 0) gather();
    image = std::move(some_[done_ % side_by_side]);
  }
  check(image);
  ++done_;
}

}  // namespace vam::io::arrays
