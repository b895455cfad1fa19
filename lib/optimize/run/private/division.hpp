// SPDX-License-Identifier: GPL-3.0-or-later
// How a volume is divided into passes.
#pragma once

#include "light/operators/operator.hpp"
#include "optimize/run/private/pass.hpp"
#include "optimize/run/volume.hpp"

namespace vam::optimize {

struct Division {
  bool whole = false;  // all slices are one pass
  int halo = 0;        // slices that a pass knows on both sides of its own

  /// The pass that begins with this one of so many jobs.
  [[nodiscard]] Pass from(int first, int jobs) const;
};

[[nodiscard]] Division division_of(const VolumeTask& task, const light::Operator& light);

}  // namespace vam::optimize
