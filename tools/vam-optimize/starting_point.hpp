// SPDX-License-Identifier: GPL-3.0-or-later
// The starting point of the iteration: a checkpoint, given projections, or those of coarser voxels.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "base/image.hpp"
#include "cli/app.hpp"
#include "io/exr/stack.hpp"
#include "io/stream/stream.hpp"
#include "model/printer.hpp"
#include "model/stack.hpp"
#include "optimize/run/prolongation.hpp"
#include "optimize/run/volume.hpp"
#include "session/job_volumes.hpp"
#include "session/scene.hpp"
#include "vam-optimize/options.hpp"

namespace vam::optimize_tool {

/// Those of the same job on voxels of twice the size: half of the angles and bins, and nothing that is made of the
/// result alone.
[[nodiscard]] Options coarser(const Options& options);

struct CoarseStart {
  optimize::Prolongation images;  // of the finer problem's slices
  double half_width = 0;          // of the window that it reached about the threshold, in doses; 0: it did not print
  optimize::EvenDose even;        // these two do not depend on the voxels
  double eigenvalue = 0;
  double max_intensity = 0;  // the limit, as raised; 0: none
};

/// For the projections of `scene`, from `in`; a line for each level on a terminal. None where the coarser part is too
/// small to be of use, or has no light that prints it, nearly; and after an interruption, for which
/// device::interrupted() is to be asked.
[[nodiscard]] std::optional<CoarseStart> coarse_start(const session::JobVolumes& in, const session::Scene& scene,
                                                      const Options& options);

/// A problem solved, with its projections.
struct SolvedLevel {
  optimize::VolumeOutcome outcome;
  std::vector<Image> images;
};
[[nodiscard]] SolvedLevel solved(optimize::VolumeTask& task, const session::Scene& scene, const Options& options);

/// The start of a finer level from one that is solved; none where that has no light that prints the part, nearly.
[[nodiscard]] std::optional<CoarseStart> start_of(SolvedLevel level, const session::Scene& scene,
                                                  const Options& options, const session::Scene& finer,
                                                  const Options& finer_options);

/// The task starts from it.
void continue_from(CoarseStart start, optimize::VolumeTask& task, Options& options);

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

/// Finished slices and, when a signal comes, the last iterate go to a file without a name; keep() gives it one.
class Checkpoint {
 public:
  /// Opens the file if it is there. Throws Error: no_input, no_output.
  explicit Checkpoint(const std::string& path);
  Checkpoint(const Checkpoint&) = delete;
  Checkpoint& operator=(const Checkpoint&) = delete;

  /// For the task, as long as this lives; the signals must be noted (device::interruptible).
  [[nodiscard]] optimize::CheckpointState state(const std::string& job);
  /// The state appears under its name.
  void keep() { out_.commit(); }
  /// The run is complete; the state it resumed from is removed.
  void remove() const;

 private:
  void take(void* bytes, std::size_t size);
  std::string path_;
  std::optional<io::InputFile> in_;
  io::OutputFile out_;
  std::optional<optimize::Archive> from_;
  optimize::Archive to_;
};

class StartingPoint {
 public:
  /// Opens --checkpoint and --init. Throws Error: no_input, no_output, data.
  StartingPoint(const cli::App& app, const model::Printer& printer, const model::StackInfo& info,
                const Options& options);
  /// The task starts there and refers to this. Without --init the coarser levels are solved, which takes time: call it
  /// after all that may refuse the task, and ask device::interrupted() then. A checkpoint has the iterate of the pass
  /// that was interrupted; where passes may follow, these start from the coarser levels, too.
  void begin(optimize::VolumeTask& task, const session::JobVolumes& in, const session::Scene& scene,
             const light::Operator& light, Options& options);
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
  optimize::CheckpointState state_;
};

}  // namespace vam::optimize_tool
