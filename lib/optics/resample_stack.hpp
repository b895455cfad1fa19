// SPDX-License-Identifier: GPL-3.0-or-later
// Resampling of a whole stack: the plan for its slices and the metadata of the resulting stack.
#pragma once

#include <iosfwd>
#include <optional>

#include "model/printer.hpp"
#include "model/stack.hpp"
#include "optics/resample.hpp"

namespace vam::optics {

/// What is known about the alignment of one machine beside its printer settings.
struct AxisAlignment {
  double column_offset = 0;     // columns by which the axis appears to the right of where the settings say
  double angle_offset_rad = 0;  // the part stands at stage angle + this
  bool reverse = false;         // flips stage.direction
};

struct StackResampling {
  ResamplePlan plan;
  model::StackInfo info;  // of the output; the history is the caller's
};

/// The columns of the projector, the axis where it appears.
[[nodiscard]] Detector projector_detector(const model::Printer& printer, const AxisAlignment& alignment);

/// The angles of a sinogram stack.
[[nodiscard]] Turn turn_of(const model::StackInfo& info);

/// Virtual sinograms for the projector's columns. Direction and angle offset of `options` come from the printer and the
/// alignment. Throws Fault::data where the angles are not one turn or the bench is impossible.
[[nodiscard]] StackResampling stack_to_projector(const model::Printer& printer, const AxisAlignment& alignment,
                                                 const model::StackInfo& in, ResampleOptions options);

/// Camera sinograms (axis in the middle) to virtual ones with the axis of the part: the camera sees the part turned by
/// its azimuth, which counts counter-clockwise from the projector seen from above. pixel_mm: column pitch of the
/// output, by default the pitch of the slices, as voxels are cubes; columns: by default what the camera can see.
[[nodiscard]] StackResampling stack_to_virtual(const model::Printer& printer, const AxisAlignment& alignment,
                                               const model::StackInfo& in, ResampleOptions options,
                                               std::optional<double> pixel_mm, std::optional<int> columns);

/// The map as CSV: x_p_mm,x_v_mm,delta_deg,T,J,weight, one line a column; the last five are empty where a ray misses.
void write_map(std::ostream& out, const View& view, const Detector& detector, const ResampleOptions& options);

/// The columns of the camera that see the resin, axis in the middle, for write_map.
[[nodiscard]] Detector camera_detector(const model::Printer& printer, const AxisAlignment& alignment);

}  // namespace vam::optics
