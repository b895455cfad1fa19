// SPDX-License-Identifier: GPL-3.0-or-later
// --checkpoint: the state from which an interrupted run resumes.
#pragma once

#include <optional>
#include <string>

#include "cli/app.hpp"
#include "io/stream/stream.hpp"
#include "model/printer.hpp"
#include "optimize/run/volume.hpp"
#include "vam-optimize/options.hpp"

namespace vam::optimize_tool {

/// Which job a state is of: the printer, the options, what the files hold that the options name beside the volumes (the
/// slices have digests of their own), and how the limit is raised.
[[nodiscard]] std::string job_of(const cli::App& app, const model::Printer& printer, const Options& options);

/// Finished slices and, when a signal comes, the last iterate go to a file without a name; keep() gives it one.
class Checkpoint {
 public:
  /// Opens the file if it is there. Throws Error: no_input, no_output.
  explicit Checkpoint(const std::string& path);
  Checkpoint(const Checkpoint&) = delete;
  Checkpoint& operator=(const Checkpoint&) = delete;

  /// For the task, as long as this lives; the signals must be noted (device::interruptible).
  [[nodiscard]] optimize::Interruption interruption(const std::string& job);
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

}  // namespace vam::optimize_tool
