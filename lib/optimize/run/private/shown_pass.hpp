// SPDX-License-Identifier: GPL-3.0-or-later
// The dose of a pass in the light of finished images.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "optimize/run/private/pass_setup.hpp"
#include "optimize/run/volume.hpp"

namespace vam::optimize {

struct ShownPass {
  Problem problem;         // without what inserts fill and hide
  std::vector<Slab> dose;  // with what has been delivered
};

/// What the light of images gives, a slab for every 16 of the pass; image(job): fluence.
[[nodiscard]] std::vector<Slab> dose_of(const Pass& pass, const PassLight& light,
                                        const std::function<Image(int job)>& image);
/// slice(job): the slice of the volume that the job computes; image(job): its projections, fluence.
[[nodiscard]] ShownPass shown_pass(const VolumeTask& task, const light::Operator& light, const SliceReader& reader,
                                   const Pass& pass, const std::function<int(int job)>& slice,
                                   const std::function<Image(int job)>& image);

}  // namespace vam::optimize
