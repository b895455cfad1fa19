// SPDX-License-Identifier: GPL-3.0-or-later
// Problem and light of a pass, one operator around the other.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <utility>
#include <vector>

#include "light/operators/blurred_operator.hpp"
#include "optimize/run/private/pass.hpp"
#include "optimize/run/volume.hpp"

namespace vam::optimize {

/// The light, around inserts if there are any, and what beam and resin smear of it.
class PassLight {
 public:
  /// `clear` must outlive this; `around` takes its place unless it is null. No blur: 0.
  PassLight(const light::Operator& clear, std::unique_ptr<light::Operator> around, double blur_px, int slices)
      : around_(std::move(around)), sharp_(around_ ? *around_ : clear) {
    if (blur_px > 0) blurred_ = std::make_unique<light::BlurredOperator>(sharp_, blur_px, slices);
  }

  /// Its rows are the iterate's: fewer than the image's where half a turn is enough.
  [[nodiscard]] const light::Operator& sharp() const { return sharp_; }
  /// The operator of the optimisation.
  [[nodiscard]] const light::Operator& blurred() const { return blurred_ ? *blurred_ : sharp_; }

 private:
  std::unique_ptr<light::Operator> around_;
  const light::Operator& sharp_;
  std::unique_ptr<light::Operator> blurred_;
};

struct PassSetup {
  Problem problem;                 // without what inserts fill and hide
  std::vector<Slab> inserts;       // coverage, a slab for every slab of the problem; empty without any
  std::vector<std::int64_t> dark;  // of each slice's part, in the shadow of inserts from everywhere; empty without any
  PassLight light;
};

/// slice(job): the slice of the volume that the job computes.
[[nodiscard]] PassSetup set_up(const VolumeTask& task, const light::Operator& light, const SliceReader& reader,
                               const Pass& pass, const std::function<int(int job)>& slice);

}  // namespace vam::optimize
