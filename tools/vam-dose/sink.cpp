// SPDX-License-Identifier: GPL-3.0-or-later
#include "vam-dose/sink.hpp"

#include <algorithm>

#include "light/operators/insert.hpp"

namespace vam::dose_tool {

Sink::Sink(io::SparseVolume& volume, const Place& place, const Insert& insert, int first,
           std::optional<model::Circle> judged)
    : volume_(volume), target_(place.target), insert_(insert), next_(first), judged_(judged) {
  buffer_.reserve(8 * volume.grid().slice_size());
  if (target_ != nullptr) part_ = io::covered_box(*target_, model::coverage_rounding);
}

void Sink::add(Image& dose) {
  const std::vector<Image> inserts = insert_.slices(next_ + pending_, 1);
  if (!inserts.empty()) light::darken(inserts.front(), dose);  // also of what blur has brought in
  Image part;
  if (target_ != nullptr) {
    part = Image(dose.width, dose.height);
    target_->read_slices(next_ + pending_, 1, part.values.data());
  }
  range_.add(dose, part);
  if (judged_) judge(dose, part);
  buffer_.insert(buffer_.end(), dose.values.begin(), dose.values.end());
  if (++pending_ + next_ % 8 == 8) flush();
}

void Sink::flush() {
  if (pending_ > 0) volume_.write_slices(next_, pending_, buffer_.data());
  next_ += pending_;
  pending_ = 0;
  buffer_.clear();
}

void Sink::judge(const Image& dose, const Image& part) {
  for (int y = 0; y < dose.height; ++y) {
    for (int x = 0; x < dose.width; ++x) {
      const auto label = model::label_of(part(x, y));
      if (label != model::Label::part && !judged_->contains(x, y)) continue;
      statistics_.add(dose(x, y), label);
      if (label == model::Label::void_ && !part_.contains(x, y, next_ + pending_)) outside_.add(dose(x, y));
    }
  }
}

void scale(io::SparseVolume& volume, double factor) {
  const model::Grid& grid = volume.grid();
  std::vector<float> slices(grid.slice_size() * 8);
  for (int k = 0; k < grid.nz; k += 8) {
    const int count = std::min(8, grid.nz - k);
    volume.read_slices(k, count, slices.data());
    for (float& value : slices) value = static_cast<float>(value * factor);
    volume.write_slices(k, count, slices.data());
  }
}

}  // namespace vam::dose_tool
