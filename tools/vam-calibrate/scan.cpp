// SPDX-License-Identifier: GPL-3.0-or-later
#include "vam-calibrate/scan.hpp"

#include <functional>
#include <map>
#include <utility>

#include "base/error.hpp"
#include "base/utc.hpp"
#include "io/settings/calibration_record.hpp"
#include "io/settings/printer_file.hpp"

namespace vam::calibrate_tool {

namespace {

using Scan = Finding (*)(const ScanOptions&, const model::Printer&);
const std::map<std::string, Scan>& scans() {
  static const std::map<std::string, Scan> all{
      {"edges", scan_edges}, {"response", scan_response}, {"flat", scan_flat}, {"beam", scan_beam},
      {"axis", scan_axis},   {"latency", scan_latency},   {"lag", scan_lag},   {"registration", scan_registration}};
  return all;
}

}  // namespace

void run_scan(const cli::App& app, const ScanOptions& options) {
  const std::string& command = options.command;
  model::Printer printer = io::load_printer(options.printer.file, options.printer.sets, io::Records::ignore);
  if (command == "check") return check_records(options, printer);
  // The axis in the camera's image, as measured before.
  const auto axis_record = io::current_record(printer.calibration, "axis");
  if (axis_record && command != "axis" && io::objection(*axis_record, printer.calibration, utc_seconds()).empty()) {
    printer.camera.axis_column = axis_record->value("axis_column");
  }
  // A latency measured before decides which pattern frame a camera frame shows.
  const auto known = io::current_record(printer.calibration, "latency");
  if (known && command != "latency" && io::objection(*known, printer.calibration, utc_seconds()).empty()) {
    printer.projector.latency_ms = known->value("latency");
  }
  Finding finding = scans().at(command)(options, printer);
  finding.facts["settings"]["exposure_us"] = printer.camera.exposure_us;
  keep(app, options, printer.calibration, command, std::move(finding));
}

}  // namespace vam::calibrate_tool
