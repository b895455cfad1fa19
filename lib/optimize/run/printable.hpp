// SPDX-License-Identifier: GPL-3.0-or-later
// Whether there is anything to print, before and after the work.
#pragma once

#include <string>

#include "optimize/run/volume.hpp"

namespace vam::optimize {

/// Throws Fault::data when no slice of a part has a voxel that is covered by half or more: then every slice stays dark
/// (append). Empty targets are left to check().
void require_printable(const VolumeTask& task, light::Shape shape, const std::string& subject);

/// Throws Fault::data when no voxel was asked to be part, or when none of these got light, with the band about the
/// surface that is unconstrained (VolumeSource::band_px). Not for grey targets, whose figures are not doses.
void require_light(const VolumeOutcome& outcome, const std::string& subject, double band_px = 0);

}  // namespace vam::optimize
