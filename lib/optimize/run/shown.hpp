// SPDX-License-Identifier: GPL-3.0-or-later
// The figures of the frames as they are written, in the projector's grey levels.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "base/compute/aligned_memory.hpp"
#include "base/image.hpp"
#include "optimize/run/volume.hpp"

namespace vam::optimize {

/// One image a slice, from 0 on, columns x angles, fluence; dark beyond the last. What memory has no room for lies in
/// scratch files.
class Frames {
 public:
  Frames() = default;
  Frames(const std::vector<Image>& images);  // NOLINT(google-explicit-constructor): they are the same
  void add(const Image& image);
  void replace(int k, const Image& image);
  [[nodiscard]] int count() const { return count_; }
  [[nodiscard]] Image at(int k, light::Shape shape) const;

 private:
  using Block = std::vector<float, CacheAligned<float>>;
  std::vector<Block> blocks_;  // of as many images as a slab has
  int count_ = 0;
};

/// How a light with these figures is exposed: at which dose of it the resin sets, and how long that takes.
struct Exposed {
  double threshold = 0, seconds = 0;
};
using Expose = std::function<Exposed(const VolumeOutcome& outcome)>;

/// The prints of resins that set at these doses: figures, pieces, and wrong voxels slice by slice. As to vam-score
/// every voxel counts by its coverage, unless the target is grey.
[[nodiscard]] std::vector<VolumeOutcome> prints_at(VolumeTask task, const light::Operator& light, const Frames& frames,
                                                   std::span<const double> doses);

/// Makes the figures, demands and intensities of `outcome` those of `frames`, as they are exposed: pieces, wrong voxels
/// and what gels outside the part's box are counted where the resin sets, and the blur of `task` becomes that of the
/// time it takes. Memory: as a pass of optimise().
Exposed judge_shown(VolumeTask& task, const light::Operator& light, const Frames& frames, const Expose& expose,
                    const std::function<double(double seconds)>& blur_px, VolumeOutcome& outcome);

}  // namespace vam::optimize
