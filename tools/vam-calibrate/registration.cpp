// SPDX-License-Identifier: GPL-3.0-or-later
// vam-calibrate registration: height, angle and scale of the camera's volumes in the projector's frame.
#include "metrology/compare/registration.hpp"

#include <cmath>

#include "base/error.hpp"
#include "base/text/text.hpp"
#include "io/settings/printer_match.hpp"
#include "io/stream/file_type.hpp"
#include "session/surface.hpp"
#include "vam-calibrate/scan.hpp"

namespace vam::calibrate_tool {

namespace {

/// The camera as it was taken for the volume, which states it; for a mesh that of the printer file.
model::PrinterCamera camera_of(const std::string& print, const model::Printer& printer) {
  if (!io::is_volume(print)) return printer.camera;
  const auto facts = io::read_volume(print, "").metadata;
  const auto stated = facts.find("vam:printer");
  return stated == facts.end() ? printer.camera : io::parse_settings(stated->second, print + ": vam:printer").camera;
}

}  // namespace

Finding scan_registration(const ScanOptions& options, const model::Printer& printer) {
  constexpr double design_isovalue = 0.5;  // of coverage
  constexpr double wanted_angle_sigma_deg = 0.2;
  constexpr double most_aside_px = 2;
  const model::PrinterCamera camera = camera_of(options.from, printer);
  if (!camera.axis_row) {
    throw Error{Fault::usage, "registration: set camera.axis_row, from which the heights of the print were counted"};
  }
  const model::TriangleSoup print = print_surface(options.from, options.isovalue);
  const solid::Surface design(session::read_surface(options.design, design_isovalue));
  const auto found = metrology::registration(print, design, camera.pixel_mm);
  const bool other_scale = std::abs(found.scale.value - 1) > 2 * found.scale.sigma;  // else the pixel is as good
  const double pixel_mm = camera.pixel_mm * (other_scale ? found.scale.value : 1);
  // With the pixel the height of the middle changes, too.
  const double lift_mm = found.z_mm.value - (other_scale ? (found.scale.value - 1) * found.middle_z_mm : 0);
  const char* method = "least squares along the normals of the print's surface";
  Finding finding;
  finding.value("azimuth", {camera.azimuth_deg + found.angle_deg.value, found.angle_deg.sigma, found.angle_deg.n},
                "deg", method);
  finding.value("axis_row", {*camera.axis_row + lift_mm / pixel_mm, found.z_mm.sigma / pixel_mm, found.z_mm.n}, "px",
                method);
  if (other_scale) finding.value("pixel", {pixel_mm, camera.pixel_mm * found.scale.sigma, found.scale.n}, "mm", method);
  finding.value("angle", found.angle_deg, "deg", method);
  finding.value("z", found.z_mm, "mm", method);
  finding.value("scale", found.scale, "1", method);
  finding.facts["rms_mm"] = found.rms_mm;
  finding.facts["outside_mm"] = found.outside_mm;
  finding.facts["aside_mm"] = found.aside_mm;
  finding.facts["tilt_deg"] = found.tilt_deg;
  if (!found.failure.empty()) {
    finding.fail_because(found.failure);
  } else {
    finding.require_sigma("angle", found.angle_deg.sigma, wanted_angle_sigma_deg, "deg");
  }
  if (found.aside_mm > most_aside_px * pixel_mm) {
    finding.warn_because("the print lies " + format_number(found.aside_mm, 3) +
                         " mm beside the design across the axis, which no setting of the camera explains; measure "
                         "projector.axis_column (edges)");
  }
  return finding;
}

}  // namespace vam::calibrate_tool
