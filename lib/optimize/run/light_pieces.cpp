// SPDX-License-Identifier: GPL-3.0-or-later
#include "optimize/run/private/light_pieces.hpp"

#include <limits>

#include "base/index.hpp"
#include "optimize/run/private/misses.hpp"
#include "optimize/run/private/shown_pass.hpp"

namespace vam::optimize {

LightPieces::LightPieces(const VolumeTask& task, const light::Operator& light, const SliceReader& reader)
    : task_(task),
      light_(light),
      reader_(reader),
      division_(division_of(task, light)),
      target_(product(light.object().width, light.object().height)),
      pieces_(light.object().width, light.object().height, task.demands.window.threshold()) {}

void LightPieces::add(int job, const Image& image) {
  if (division_.halo == 0 && !held_.empty() && held_.back().job == job) {
    ++held_.back().count;
  } else {
    // The pass is complete, and no more slices are like its last one.
    const int known = first_ + count_of(held_);
    const Pass pass = division_.from(next_, std::numeric_limits<int>::max());
    if (pass.high <= known) count(pass);
    held_.push_back({image, job, slices_, 1});
  }
  ++slices_;
}

void LightPieces::count(const Pass& pass) {
  const auto of = [&](int number) -> const Alike& { return held_[number - first_]; };
  const ShownPass shown = shown_pass(
      task_, light_, reader_, pass, [&](int number) { return of(number).slice; },
      [&](int number) { return of(number).image; });
  for_each_dose(shown.dose, shown.problem, pass.first - pass.low, pass.last - pass.low,
                [&](int first, int count, const float* doses) {
                  for (int k = 0; k < count; ++k) {
                    const Alike& alike = of(pass.low + first + k);
                    task_.source.target(alike.slice, 1, target_.data());
                    for (int n = 0; n < alike.count; ++n)
                      pieces_.add(doses + product(k, target_.size()), target_.data(), 1);
                  }
                });
  next_ = pass.last;
  const int low = division_.from(next_, std::numeric_limits<int>::max()).low;
  for (; first_ < low; ++first_) held_.pop_front();
}

verdict::PrintPieces LightPieces::found() {
  const int all = first_ + count_of(held_);
  while (next_ < all) count(division_.from(next_, all));
  return pieces_.found();
}

}  // namespace vam::optimize
