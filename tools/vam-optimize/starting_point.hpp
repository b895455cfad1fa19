// SPDX-License-Identifier: GPL-3.0-or-later
// The starting point of the iteration: a checkpoint, or given projections.
#pragma once

#include <map>
#include <optional>
#include <string>

#include "base/image.hpp"
#include "cli/app.hpp"
#include "io/exr/stack.hpp"
#include "io/stream/stream.hpp"
#include "model/printer.hpp"
#include "model/stack.hpp"
#include "optimize/run/volume.hpp"
#include "vam-optimize/options.hpp"

namespace vam::optimize_tool {

/// Reads a stack slice after slice, the last 64 of which may be read again; slices in between are skipped. Those beyond
/// its last one are dark.
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
  /// Opens the file of --checkpoint if it is there. Throws Error: no_input, no_output.
  Checkpoint(const cli::App& app, const model::Printer& printer, const Options& options);
  Checkpoint(const Checkpoint&) = delete;
  Checkpoint& operator=(const Checkpoint&) = delete;

  /// For the task, as long as this lives; the signals must be noted (device::interruptible).
  [[nodiscard]] optimize::CheckpointState state();
  /// The state appears under its name.
  void keep() { out_.commit(); }
  /// The run is complete; the state it resumed from is removed.
  void remove() const;

 private:
  void take(void* bytes, std::size_t size);
  std::string path_, job_;
  std::optional<io::InputFile> in_;
  io::OutputFile out_;
  std::optional<optimize::Archive> from_;
  optimize::Archive to_;
};

}  // namespace vam::optimize_tool
