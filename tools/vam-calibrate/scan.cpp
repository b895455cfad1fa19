// SPDX-License-Identifier: GPL-3.0-or-later
#include "vam-calibrate/scan.hpp"

#include <utility>

#include "base/error.hpp"
#include "base/text/json_text.hpp"
#include "base/text/utc.hpp"
#include "io/image/capture_folder.hpp"
#include "io/settings/printer_file.hpp"
#include "metrology/cure/bodies.hpp"
#include "session/surface.hpp"

namespace vam::calibrate_tool {

std::optional<io::CalibrationRecord> usable_record(const model::Calibration& calibration, const std::string& scan) {
  auto record = io::current_record(calibration, scan);
  if (record && !io::objection(*record, calibration, utc_seconds()).empty()) record.reset();
  return record;
}

model::TriangleSoup print_surface(const std::string& path, std::optional<double> isovalue) {
  return session::read_surface(path, isovalue,
                               [&](model::Volume& volume) { (void)metrology::keep_bodies(volume, *isovalue, {}); });
}

void run_scan(const cli::App& app, const std::string& command, Scan scan, ScanOptions& options) {
  options.command = command;
  model::Printer printer = io::load_printer(options.printer.file, options.printer.sets, io::Records::ignore);
  // As measured before, the axis in the camera's image, and the latency, which decides which pattern frame a camera
  // frame shows; but for the one that is to be replaced, which may be damaged or gone.
  const auto apply = [&](const char* other, const char* value, auto& to) {
    if (other == command) return;
    if (const auto record = usable_record(printer.calibration, other)) to = record->value(value);
  };
  apply("axis", "axis_column", printer.camera.axis_column);
  apply("latency", "latency", printer.projector.latency_ms);
  if (options.from != "-" && io::is_capture_folder(options.from)) {  // which states how its frames were exposed
    double& exposure_us = printer.camera.exposure_us;
    exposure_us = number_at(Json::parse(io::read_manifest(options.from).head), "exposure_us", exposure_us);
  }
  Finding finding = scan(options, printer);
  finding.facts["settings"]["exposure_us"] = printer.camera.exposure_us;
  keep(app, options, printer, std::move(finding));
}

}  // namespace vam::calibrate_tool
