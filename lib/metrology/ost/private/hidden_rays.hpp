// SPDX-License-Identifier: GPL-3.0-or-later
// Rays that bubbles hide at both ends of their line, restored from the bodies that all rays show.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "base/image.hpp"
#include "metrology/ost/private/body_paths.hpp"
#include "metrology/ost/private/ray_mask.hpp"

namespace vam::metrology {

/// Rays, one mask an angle, that are brighter by `least` than what they pass of the bodies, as are those next to them,
/// and rays around them. Those that are `known` to be suspect are not looked at. Nothing where they are more than
/// `most`.
[[nodiscard]] std::optional<std::vector<RayMask>> rays_above(const BodyPaths& bodies,
                                                             const std::vector<Image>& sinograms,
                                                             const std::vector<RayMask>& known, std::ptrdiff_t most,
                                                             float least);

/// The rays that are seen, but for hidden ones: those become at most what they pass of the bodies plus what the rays of
/// that column before and after, which are not hidden, differ by from it, up to `farthest`; and at most the other end
/// of their line plus the difference of what both ends pass. Those within `least` of it stay.
void limit_to_bodies(const BodyPaths& bodies, const std::vector<RayMask>& hidden, float least, float farthest,
                     const std::vector<Image>& seen, std::vector<Image>& sinograms);

}  // namespace vam::metrology
