// SPDX-License-Identifier: GPL-3.0-or-later
// Level faces that rays that climb cannot print sharply.
#pragma once

#include "base/text/json_fwd.hpp"
#include "io/vdb/vdb.hpp"
#include "optimize/run/volume.hpp"
#include "session/scene.hpp"
#include "vam-optimize/options.hpp"

namespace vam::optimize_tool {

/// The field blurred_faces of the report, and a warning where there are any. Nothing where rays stay level or the part
/// moves.
void add_blurred_faces(Json& report, const optimize::VolumeOutcome& outcome, const session::Scene& scene,
                       const io::SparseVolume& target, const Options& options);

}  // namespace vam::optimize_tool
