// SPDX-License-Identifier: GPL-3.0-or-later
#include "vam-calibrate/scan.hpp"

#include <utility>

#include "base/error.hpp"
#include "base/text/json_text.hpp"
#include "base/text/utc.hpp"
#include "io/image/capture_folder.hpp"
#include "io/settings/calibration_record.hpp"
#include "io/settings/printer_file.hpp"
#include "metrology/cure/bodies.hpp"
#include "session/surface.hpp"

namespace vam::calibrate_tool {

namespace {

// For a scan of another kind: one that is to be replaced may be damaged or gone.
std::optional<io::CalibrationRecord> usable_record(const model::Calibration& calibration, const std::string& scan,
                                                   const std::string& command) {
  if (scan == command) return std::nullopt;
  auto record = io::current_record(calibration, scan);
  if (record && !io::objection(*record, calibration, utc_seconds()).empty()) record.reset();
  return record;
}

}  // namespace

model::TriangleSoup print_surface(const std::string& path, std::optional<double> isovalue) {
  return session::read_surface(path, isovalue,
                               [&](model::Volume& volume) { (void)metrology::keep_bodies(volume, *isovalue, {}); });
}

void run_scan(const cli::App& app, const std::string& command, Scan scan, ScanOptions& options) {
  options.command = command;
  model::Printer printer = io::load_printer(options.printer.file, options.printer.sets, io::Records::ignore);
  // The axis in the camera's image, as measured before.
  if (const auto axis = usable_record(printer.calibration, "axis", command)) {
    printer.camera.axis_column = axis->value("axis_column");
  }
  // A latency measured before decides which pattern frame a camera frame shows.
  if (const auto latency = usable_record(printer.calibration, "latency", command)) {
    printer.projector.latency_ms = latency->value("latency");
  }
  if (options.from != "-" && io::is_capture_folder(options.from)) {  // which states how its frames were exposed
    double& exposure_us = printer.camera.exposure_us;
    exposure_us = number_at(Json::parse(io::read_manifest(options.from).head), "exposure_us", exposure_us);
  }
  Finding finding = scan(options, printer);
  finding.facts["settings"]["exposure_us"] = printer.camera.exposure_us;
  keep(app, options, printer, std::move(finding));
}

}  // namespace vam::calibrate_tool
