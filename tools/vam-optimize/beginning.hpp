// SPDX-License-Identifier: GPL-3.0-or-later
// Where the iteration begins: at a checkpoint, at projections that are given, or at those of coarser voxels.
#pragma once

#include <optional>

#include "cli/app.hpp"
#include "vam-optimize/checkpoint.hpp"
#include "vam-optimize/coarse_start.hpp"
#include "vam-optimize/inputs.hpp"
#include "vam-optimize/light.hpp"
#include "vam-optimize/options.hpp"

namespace vam::optimize_tool {

class Beginning {
 public:
  /// Opens --checkpoint and --init. Throws Error: no_input, no_output, data.
  Beginning(const cli::App& app, const model::Printer& printer, const model::StackInfo& info, const Options& options);
  /// The task starts there and refers to this. Without --init the coarser levels are solved, which takes time: call it
  /// after all that may refuse the task, and ask device::interrupted() then. A checkpoint has the iterate of the pass
  /// that was interrupted; where passes may follow, these start from the coarser levels, too.
  void begin(optimize::VolumeTask& task, const Inputs& in, const Scene& scene, const light::Operator& light,
             Options& options);
  /// The run was interrupted: the checkpoint appears.
  void keep() { checkpoint_->keep(); }
  /// The run is complete.
  void remove() const {
    if (checkpoint_) checkpoint_->remove();
  }

 private:
  int count_, width_, height_;  // of the projections
  std::optional<Initial> initial_;
  std::optional<Checkpoint> checkpoint_;
  optimize::Interruption interruption_;
};

}  // namespace vam::optimize_tool
