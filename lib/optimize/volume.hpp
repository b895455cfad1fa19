// A whole volume, pass by pass in constant memory: distinct slices are packed, optimised, brought to one printing
// threshold, and handed out in ascending order.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "base/image.hpp"
#include "base/json.hpp"
#include "optimize/iterate.hpp"

namespace vam::optimize {

struct VolumeTask {
  int slices = 0;
  Circle circle;
  Window window;
  Limits limits;
  bool watch = false;                                      // fill the trace
  std::size_t keep_bytes = std::size_t{512} << 20U;        // finished projections held for identical slices to come
  std::function<void(int k, int count, float* out)> read;  // `count` row-major slices from k on
  std::function<void(int k, int count, float* out)> read_insert;           // coverage of an opaque insert; may be empty
  std::function<std::unique_ptr<Operator>(std::span<const Slab>)> around;  // the operator of a pass with these inserts
  std::function<Image(int k)> initial;  // image to start from (fluence); none = from nothing
  std::function<std::unique_ptr<Method>()> make;
  std::function<void(int k, const Image& image)> write;  // takes slices 0, 1, 2 ...: columns x angles, fluence
  std::function<void(int slices)> progress;              // so many more slices are done; may be empty
};

struct VolumeOutcome {
  int jobs = 0;                           // distinct slices computed
  int iterations = 0;                     // most of any pass
  std::string reason;                     // of the pass with most iterations
  std::vector<model::DoseMetrics> trace;  // after 0, 1, ... iterations (SliceFigures::mean), when watched
  model::DoseMetrics metrics;             // of the result, at the common threshold
  double efficiency = 0;
  long dark_part_voxels = 0;  // of the part, behind the insert from everywhere
};

/// All calls of the task's functions come from the calling thread. Throws Fault::data when a slice has part outside
/// the circle.
VolumeOutcome optimise(const VolumeTask& task, const Operator& light);

/// The fewest columns that see the circle, odd or even as nx, so that the columns of angle 0 are voxels.
[[nodiscard]] int columns_for(const Circle& circle, int nx);

/// For --report and --trace.
[[nodiscard]] Json report(const VolumeOutcome& outcome);
[[nodiscard]] std::string trace_csv(const std::vector<model::DoseMetrics>& trace);

}  // namespace vam::optimize
