// The gain of the preconditioner for parallel rays.
#pragma once

#include "tomo/filter.hpp"
#include "tomo/radon.hpp"

namespace vam::light {

/// A A* falls off like 1/|k| from the lowest frequency that the circle holds, about 0.64 / columns cycles per column,
/// up to where neighbouring angles see different things, (angles over half a turn) / (pi columns); beyond, it is flat.
/// The ramp, floored and capped there, inverts that [physics §6].
[[nodiscard]] tomo::FilterSpec preconditioner_spec(const tomo::ParallelGeometry& rows);

}  // namespace vam::light
