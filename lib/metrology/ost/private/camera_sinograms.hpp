// Views of a turn, row by row, to what one height shows at every angle.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "metrology/ost/private/angle_grid.hpp"
#include "metrology/ost/private/heights.hpp"
#include "metrology/ost/views.hpp"

namespace vam::metrology {

/// Sinograms in camera columns x even angles, one for each height of `rows`.
[[nodiscard]] std::vector<Image> camera_sinograms(std::span<const CameraView> views, const AngleGrid& turn,
                                                  const AxisPose& axis, const LevelRows& rows, std::size_t heights);

}  // namespace vam::metrology
