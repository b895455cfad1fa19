// SPDX-License-Identifier: GPL-3.0-or-later
// Alignment by chosen faces: 3-2-1 (ISO 5459) [physics §8].
#pragma once

#include <array>

#include "metrology/compare/fits.hpp"
#include "solid/mesh/align.hpp"

namespace vam::metrology {

/// A face of the print, and the same of the design.
struct DatumFace {
  PlaneFit print;
  PlaneFit design;
};

/// The motion that lays the primary face on the design's, turns the secondary one about its normal onto the design's
/// direction, and fixes the third shift by the tertiary. Throws Fault::data where faces are nearly parallel.
[[nodiscard]] solid::Similarity datum_motion(const std::array<DatumFace, 3>& faces);

/// First b, then a.
[[nodiscard]] solid::Similarity after(const solid::Similarity& a, const solid::Similarity& b);

}  // namespace vam::metrology
