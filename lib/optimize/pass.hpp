// A pass: the up to 64 slices that are optimised together, what their voxels must become, and arithmetic slice by
// slice.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "base/parallel.hpp"
#include "model/circle.hpp"
#include "model/dose_metrics.hpp"
#include "optimize/cure_curve.hpp"
#include "tomo/slab.hpp"

namespace vam::optimize {

using model::Label;
using tomo::lanes;
using tomo::Slab;

inline constexpr int slabs_per_pass = 4;
inline constexpr int slices_per_pass = slabs_per_pass * lanes;

using model::Circle;

/// The doses between which the print's threshold may lie: void below low, part above high. The printing threshold is
/// in the middle, the same number for every slice.
struct Window {
  double low = 0.75;
  double high = 0.85;
  [[nodiscard]] double threshold() const { return 0.5 * (low + high); }
};

/// What is asked of all slices.
struct Demands {
  Window window;
  bool surface = false;  // voxels that the part's surface cuts are asked too: part from half coverage on, else void
  bool grey = false;     // the target is a response for every voxel, to be met within its tolerance
  CureCurve curve = CureCurve::logistic(Window{}.threshold(), 0.05);  // of the losses that look at the response
  double band = 0.1;  // epsilon: how far the response may be from the target, where no tolerance is given
};

/// Throws Fault::usage for contradictory thresholds.
void check(const Demands& demands);

/// Whether anything is asked of such a voxel.
[[nodiscard]] constexpr bool asked(Label label) { return label == Label::part || label == Label::void_; }

struct Problem {
  int slices = 0;                          // lanes in use, from the first
  std::vector<Slab> target;                // coverage 0...1 or response, zero outside the circle
  std::vector<std::vector<Label>> labels;  // per slab, indexed like Slab::values; grey: part where the target is not 0
  Demands demands;
  std::vector<Slab> weight;     // what an error of this voxel costs, the largest of a slice 1; empty: all 1
  std::vector<Slab> tolerance;  // epsilon of this voxel; empty: demands.band

  [[nodiscard]] float weight_at(std::size_t s, std::size_t i) const {
    return weight.empty() ? 1.0F : weight[s].values[i];
  }
  [[nodiscard]] float tolerance_at(std::size_t s, std::size_t i) const {
    return tolerance.empty() ? static_cast<float>(demands.band) : tolerance[s].values[i];
  }
};

/// Row-major slices, one after the other, in every array. Nullptr: none.
struct Slices {
  const float* target;
  const float* weight = nullptr;     // >= 0, relative to each other; a voxel of weight 0 is asked for nothing
  const float* tolerance = nullptr;  // >= 0
};

/// Adds up to 16 slices in a slab of their own. What lies outside the circle is left out (check with reach()). A slice
/// without any voxel wholly inside the part is a thin wall's or is cut by a flat end of the part: if its largest
/// coverage is at least a half it is printed, scaled so that this is 1, with the voxels of at least half of it for
/// part; otherwise it stays dark.
void append(Problem& problem, const Slices& slices, int count, int width, int height, const Circle& circle);

/// `count` row-major slices of width x height, one after the other, and weights and tolerances for them if there are
/// any. Throws Fault::usage for contradictory thresholds.
[[nodiscard]] Problem make_problem(const float* slices, int count, int width, int height, const Circle& circle,
                                   const Demands& demands, const float* weight = nullptr,
                                   const float* tolerance = nullptr);

/// Voxels that an insert fills to a half or more are neither part nor void.
void exclude(Problem& problem, std::span<const Slab> inserts);

class Operator;

/// Voxels of part or void that no light can reach are left out too; returns how many of the part's there were in each
/// slice.
[[nodiscard]] std::vector<std::int64_t> exclude_dark(Problem& problem, const Operator& light);

/// Distance from the axis to the farthest voxel centre with coverage, in voxels; -1 for an empty slice.
[[nodiscard]] double reach(const float* slice, int width, int height, double axis_x, double axis_y);

/// One number for each slice of the pass: values[slab][lane].
using PerSlice = std::vector<std::array<float, lanes>>;

/// As many slabs of that shape as `like`.
[[nodiscard]] std::vector<Slab> slabs(std::size_t count, int width, int height);

/// work(slab, first, last): the slab's values [first, last), whole lane groups, shared among the threads.
template <class Work>
void for_values(std::span<const Slab> like, const Work& work) {
  if (like.empty()) return;
  const int rows = like[0].height;
  const std::size_t row = static_cast<std::size_t>(like[0].width) * lanes;
  parallel_for(static_cast<int>(like.size()) * rows, [&](int i) {
    const std::size_t first = static_cast<std::size_t>(i % rows) * row;
    work(static_cast<std::size_t>(i / rows), first, first + row);
  });
}

/// Sum over each slice of value(slab, index), the rows of a slice added in order.
template <class Value>
[[nodiscard]] PerSlice summed(std::span<const Slab> like, const Value& value) {
  PerSlice result(like.size());
  for (auto& lane : result) lane.fill(0.0F);
  if (like.empty()) return result;
  const auto rows = static_cast<std::size_t>(like[0].height);
  const std::size_t row = static_cast<std::size_t>(like[0].width) * lanes;
  std::vector<std::array<float, lanes>> partial(like.size() * rows);
  for_values(like, [&](std::size_t s, std::size_t first, std::size_t last) {
    std::array<float, lanes> sum{};
    for (std::size_t i = first; i < last; i += lanes) {
      for (std::size_t lane = 0; lane < lanes; ++lane) sum[lane] += value(s, i + lane);
    }
    partial[s * rows + first / row] = sum;
  });
  std::vector<std::array<double, lanes>> totals(like.size());
  for (std::size_t i = 0; i < partial.size(); ++i) {
    for (std::size_t lane = 0; lane < lanes; ++lane) totals[i / rows][lane] += static_cast<double>(partial[i][lane]);
  }
  for (std::size_t s = 0; s < totals.size(); ++s) {
    for (std::size_t lane = 0; lane < lanes; ++lane) result[s][lane] = static_cast<float>(totals[s][lane]);
  }
  return result;
}

/// 1 / value, 0 for 0.
[[nodiscard]] PerSlice reciprocal(PerSlice values);
/// now = before for the slices whose `back` is not 0.
void restore(std::vector<Slab>& now, const std::vector<Slab>& before, const PerSlice& back);

/// Smallest value of each slice.
[[nodiscard]] PerSlice minima(std::span<const Slab> images);
/// Largest value of each slice.
[[nodiscard]] PerSlice largest(std::span<const Slab> images);
/// Largest value of each slice inside the circle, at least 0.
[[nodiscard]] PerSlice maxima(std::span<const Slab> images, const Problem& problem);
/// Sum of each slice's values inside the circle.
[[nodiscard]] PerSlice sums(std::span<const Slab> images, const Problem& problem);
/// images[slice] *= factor[slice].
void scale(std::span<Slab> images, const PerSlice& factor);
/// images = max(images, floor).
void clip_below(std::span<Slab> images, float floor);

/// Dose statistics of each slice in use.
[[nodiscard]] std::vector<model::DoseStatistics> statistics(std::span<const Slab> dose, const Problem& problem);

/// Figures of each slice in use. Of a grey target: ver = share of the voxels whose response is outside its tolerance,
/// pw = the least margin that any has to the edge of it, negative when outside, ipdr = largest error, cv = root mean
/// square error, iou = 1 - ver.
[[nodiscard]] std::vector<model::DoseMetrics> metrics(std::span<const Slab> dose, const Problem& problem);

/// The factor for each slice that puts window.threshold() in the middle of the slice's own process window or, where
/// that window is wider than needed, its least part dose on window.high; 0 for a slice without part. This is what makes
/// one threshold dose print all slices. Grey targets are doses already: 1.
[[nodiscard]] PerSlice to_common_threshold(const std::vector<model::DoseMetrics>& slices, const Problem& problem);

}  // namespace vam::optimize
