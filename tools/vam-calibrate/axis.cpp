// SPDX-License-Identifier: GPL-3.0-or-later
// vam-calibrate axis: the rotation axis in the camera's frames, over a turn.
#include "metrology/calibrate/axis.hpp"

#include <algorithm>

#include "vam-calibrate/scan.hpp"

namespace vam::calibrate_tool {

BeadTurn read_turn(const ScanOptions& options, const model::Printer& printer, ColumnsOfBands columns_of) {
  BeadTurn turn;
  turn.scan.middle.resize(options.heights);
  each_frame(options, printer, FrameKind::turned, [&](const ScanFrame& frame) {
    const auto middles = columns_of(frame.image, options.heights);
    for (std::size_t b = 0; b < middles.size(); ++b) turn.scan.middle[b].push_back(middles[b]);
    turn.scan.angle_deg.push_back(frame.angle_deg);
    turn.time_s.push_back(frame.time_s);
    turn.time_sigma_s = std::max(turn.time_sigma_s, frame.time_sigma_s);
    turn.scan.rows = frame.image.height;
    turn.pixel_mm = frame.pixel_mm;
  });
  return turn;
}

Finding scan_axis(const ScanOptions& options, const model::Printer& printer) {
  const BeadTurn turn = read_turn(options, printer, metrology::bright_middles);
  const double pixel_mm = turn.pixel_mm;
  const auto found = metrology::find_camera_axis(turn.scan);
  Finding finding;
  const char* method = "first harmonic over the turn";
  finding.value("axis_column", found.column, "px", method);
  finding.value("tilt", found.tilt_deg, "deg", "line through the axis columns by row");
  finding.value("wobble", found.wobble_px, "px", method);
  finding.value("wobble_phase", found.phase_deg, "deg", method);
  finding.value("wobble_mm", {found.wobble_px.value * pixel_mm, found.wobble_px.sigma * pixel_mm, found.wobble_px.n},
                "mm", method);
  finding.require_sigma("axis", found.column.sigma, wanted_axis_sigma_px, "px");
  return finding;
}

}  // namespace vam::calibrate_tool
