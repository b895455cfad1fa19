// SPDX-License-Identifier: GPL-3.0-or-later
// A pass of a volume: the jobs whose slices are optimised together, packed 16 to a slab.
#pragma once

#include <functional>
#include <vector>

#include "base/image.hpp"
#include "light/operators/operator.hpp"
#include "optimize/target/problem.hpp"
#include "optimize/target/slice_reader.hpp"

namespace vam::optimize {

/// The jobs [first, last) are the pass's own, [low, high) it knows, because they share dose with its own.
struct Pass {
  int first, last, low, high;
  [[nodiscard]] int jobs() const { return last - first; }
  [[nodiscard]] int slices() const { return high - low; }
};

/// The demands on a pass, and the inserts in its light.
struct PassInput {
  Problem problem;
  std::vector<Slab> inserts;  // coverage, a slab for every slab of the problem; empty without any
};

/// slice(job): the slice of the volume that the job computes; stacked: as in Problem.
[[nodiscard]] PassInput read_pass(const Pass& pass, const std::function<int(int job)>& slice, const SliceReader& reader,
                                  light::Shape object, const Circle& circle, const Demands& demands, bool stacked);

/// The sinograms whose images are image(job), fluence.
[[nodiscard]] std::vector<Slab> collapse_images(const Pass& pass, const std::function<Image(int job)>& image,
                                                const light::Operator& light);
/// The images of the pass's slab of that number, of its own jobs only.
[[nodiscard]] std::vector<Image> expand_slab(const Pass& pass, std::size_t number, const Slab& sinogram,
                                             const light::Operator& light);
/// The images of all slabs.
[[nodiscard]] std::vector<Image> expand_images(const Pass& pass, std::span<const Slab> sinograms,
                                               const light::Operator& light);

}  // namespace vam::optimize
