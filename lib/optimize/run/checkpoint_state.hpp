// SPDX-License-Identifier: GPL-3.0-or-later
// The saved state of a run: the projections of finished passes, one record each, then the open pass.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/image.hpp"
#include "light/operators/operator.hpp"
#include "optimize/methods/archive.hpp"
#include "optimize/run/run_method.hpp"
#include "optimize/target/schedule.hpp"

namespace vam::optimize {

/// Where a run saves its state, and resumes from; of no use after a run that finished.
struct CheckpointState {
  Pause pause;              // may be empty
  Archive* to = nullptr;    // where the state goes; none: nothing is kept
  Archive* from = nullptr;  // the state to go on from; none: from the start
  std::string job;          // what the state must be of: method, options, light
};

/// Which run a state is of.
struct RunMark {
  std::string job;
  SliceDigest target{};  // of all slices
  bool watched = false;  // the trace is part of the state
};

/// The mark out, or in: then throws Fault::data when it is another run's.
void exchange(Archive& archive, const RunMark& mark);

/// The projections of a pass that is finished.
void keep_finished(Archive& to, std::vector<Image>& images);
/// The open pass follows; its state is the caller's.
void begin_open(Archive& to);
/// The next record: projections of 1...most jobs, or nothing when the open pass follows. Throws Fault::data for what is
/// neither.
[[nodiscard]] std::optional<std::vector<Image>> next_finished(Archive& from, light::Shape image, int most);

}  // namespace vam::optimize
