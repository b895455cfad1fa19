// SPDX-License-Identifier: GPL-3.0-or-later
// What vam-optimize reads: the volumes, and projections to start from.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "base/image.hpp"
#include "io/exr/stack.hpp"
#include "io/vdb/vdb.hpp"
#include "model/stack.hpp"
#include "vam-optimize/options.hpp"

namespace vam::optimize_tool {

/// The volumes of a job, those after the target may be missing. All are on one grid but the dose that was delivered,
/// which is that of all resin that light reaches.
struct Inputs {
  std::vector<io::SparseVolume> target, insert, weight, tolerance;  // at most one each
  std::vector<io::SparseVolume> delivered;                          // doses, which add

  [[nodiscard]] const model::Grid& grid() const { return target.front().grid(); }
};

/// Target, insert, weight and tolerance of the target's file; the latter two may have files of their own, as the dose
/// that was delivered has. Throws Fault::data when there is no target, another of these is on another grid, or the dose
/// is not in mJ/cm3.
[[nodiscard]] Inputs read(const Options& options);

/// Reads a stack slice after slice, the last 64 of which may be read again; slices in between are skipped.
class Initial {
 public:
  /// Throws Fault::data unless the stack has the size of `want`.
  Initial(const std::string& path, const model::StackInfo& want);
  Image operator()(int k);

 private:
  std::string path_;
  io::StackReader reader_;
  std::map<int, Image> recent_;  // passes that share dose overlap, and come back to some slices
  int next_ = 0;
};

}  // namespace vam::optimize_tool
