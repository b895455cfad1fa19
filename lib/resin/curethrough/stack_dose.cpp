// SPDX-License-Identifier: GPL-3.0-or-later
#include "resin/curethrough/stack_dose.hpp"

#include <cmath>
#include <string>

#include "base/compute/parallel.hpp"
#include "base/error.hpp"

namespace vam::resin {

StackDose::StackDose(const CureLimits& limits, double full) : limits_(limits), full_(full) {}

void StackDose::add(const Image& slice) {
  if (slices_ % block_slices == 0) {
    at_start_.emplace_back(slice.width, slice.height);
    gathered_.assign(slice.size(), 0.0);
    weight_ = 1;
  }
  Image& block = at_start_.back();
  if (slice.width != at_start_.front().width || slice.height != at_start_.front().height) {
    throw Error{Fault::data, "slice " + std::to_string(slices_) + ": " + std::to_string(slice.width) + " x " +
                                 std::to_string(slice.height) + " pixels, the first has " +
                                 std::to_string(at_start_.front().width) + " x " +
                                 std::to_string(at_start_.front().height)};
  }
  ++slices_;
  const double factor = limits_.gain * full_ * weight_;  // gain Phi q^(n - first node of the block)
  weight_ *= limits_.q;
  parallel_for(slice.height, [&](int y) {
    const float* from = slice.row(y);
    double* sum = gathered_.data() + slice.index(0, y);
    float* to = block.row(y);
    for (int x = 0; x < slice.width; ++x) {
      sum[x] += factor * static_cast<double>(from[x]);
      to[x] = static_cast<float>(sum[x]);
    }
  });
}

void StackDose::turn() {
  turned_ = true;
  gathered_ = {};
  if (at_start_.empty()) return;
  at_start_.emplace_back(at_start_.front().width, at_start_.front().height);
  const auto power = static_cast<float>(std::pow(limits_.q, block_slices));  // the last block adds to 0 below it
  for (std::size_t b = at_start_.size() - 1; b-- > 0;) {
    Image& here = at_start_[b];
    const Image& next = at_start_[b + 1];
    parallel_for(here.height, [&](int y) {
      for (int x = 0; x < here.width; ++x) here(x, y) += power * next(x, y);
    });
  }
}

void StackDose::replay_row(int first, std::span<const Image> block, int y, float* below) const {
  const auto next = static_cast<std::size_t>(first / block_slices) + 1;
  if (!turned_ || next >= at_start_.size()) throw Error{Fault::bug, "stack dose: replayed too early or too far"};
  const Image& end = at_start_[next];
  const auto width = static_cast<std::size_t>(end.width);
  std::vector<double> omega(end.row(y), end.row(y) + width);
  for (std::size_t i = block.size(); i-- > 0;) {
    const float* phi = block[i].row(y);
    float* out = below + i * width;
    for (std::size_t x = 0; x < width; ++x) {
      out[x] = static_cast<float>(omega[x]);
      omega[x] = limits_.next(full_ * static_cast<double>(phi[x]), omega[x]);
    }
  }
}

}  // namespace vam::resin
