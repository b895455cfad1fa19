// SPDX-License-Identifier: GPL-3.0-or-later
// The dose that the resin has received before the light of this job.
#pragma once

#include "base/json_fwd.hpp"
#include "optimize/target/slice_reader.hpp"
#include "vam-optimize/inputs.hpp"
#include "vam-optimize/light.hpp"

namespace vam::optimize_tool {

/// Slices of it, in the unit of the projections' dose: over their threshold as the dose is over the resin's. Empty
/// where none was delivered. Throws Fault::usage when the resin's critical dose is not known, Fault::data when the dose
/// is on another grid than the light's.
[[nodiscard]] optimize::VolumeSource::Read delivered_dose(const Scene& scene, const Inputs& in, const Options& options);

/// What was delivered: to the part, on average, and the void that has gelled by it, which no light can undo. Nothing
/// where none was.
void report_delivered(Json& report, const optimize::VolumeSource& source, const Scene& scene, const Options& options);

}  // namespace vam::optimize_tool
