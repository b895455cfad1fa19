#include "vam-capture/scan.hpp"

#include <functional>
#include <map>

#include "base/error.hpp"
#include "io/settings/calibration_record.hpp"
#include "io/settings/printer_file.hpp"

namespace vam::capture_tool {

namespace {

using Scan = Finding (*)(const ScanOptions&, const model::Printer&);
const std::map<std::string, Scan>& scans() {
  static const std::map<std::string, Scan> all{{"edges", scan_edges}, {"response", scan_response},
                                               {"flat", scan_flat},   {"beam", scan_beam},
                                               {"axis", scan_axis},   {"latency", scan_latency}};
  return all;
}

void add_input(cli::App& scan, ScanOptions& options, bool with_flips) {
  scan.option("--from", "FILE", options.from,
              "The frames: an EXR stack or folder of vam-capture, or a folder of pictures.");
  if (with_flips) {
    scan.option("--flips", "FILE", options.flips,
                "Log of vam-project while they were taken: tells which picture each frame shows. Without it frame n "
                "shows picture n.");
  }
  scan.option("--devices", "FILE", options.devices,
              "JSON for the record, like {\"camera\": ...}: what identify says of each device that took part.");
  cli::add_printer(scan, options.printer);
}

}  // namespace

void add_scans(cli::App& app, ScanOptions& options, std::string& chosen) {
  auto& edge = app.subcommand("edges", "where the vial stands: edges, radius and tilt from a sweep", chosen);
  add_input(edge, options, true);
  edge.option("--pitch", "PX", options.pitch_px, {1, 1000}, "Step of the sweep.");
  edge.option("--width", "PX", options.width_px, {1, 1000}, "Of its line.");
  edge.option("--bands", "N", options.bands, {1, 100}, "Heights that are measured apart.");
  edge.flag("--accept", options.accept, "Also when the vial moved or changed since the record before.");
  auto& ramp = app.subcommand("response", "grey level to light, from a ramp of uniform levels", chosen);
  add_input(ramp, options, true);
  ramp.option("--steps", "N", options.steps, {2, 65536}, "Levels of the ramp.");
  ramp.option("--dark", "FILE", options.dark, "Picture or stack without any light.");
  auto& even = app.subcommand("flat", "the camera's flat field, from frames of an even scene", chosen);
  add_input(even, options, true);
  even.option("--dark", "FILE", options.dark, "Picture or stack without any light.");
  auto& line = app.subcommand(
      "beam", "width and divergence of a lit line, on a sensor moved along the light or in resin", chosen);
  add_input(line, options, true);
  line.flag("--side", options.side,
            "The frames are the camera's, of a lit row in fluorescing resin (vam-project --pattern row).");
  line.option("--dark", "FILE", options.dark, "Picture or stack without the projector's light.");
  line.option("--first", "MM", options.first_mm, cli::any, "Plane of the first frame, from the rotation axis.");
  line.option("--step", "MM", options.step_mm, cli::any, "From plane to plane.");
  line.option("--pixel", "MM", options.pixel_mm, cli::non_negative, "Of the bare sensor; with --side at the axis.");
  auto& turn = app.subcommand("axis", "rotation axis and wobble in the camera's frames, over a turn", chosen);
  add_input(turn, options, false);
  turn.option("--step", "DEG", options.step_deg, cli::any, "Angle between frames that carry none.");
  turn.option("--bands", "N", options.bands, {1, 100}, "Heights that are measured apart.");
  add_input(app.subcommand("latency", "from a flip to its light, from a blinking screen", chosen), options, true);
  auto& check =
      app.subcommand("check", "print the current records as JSON; status 65 when one must not be used", chosen);
  check.option("--need", "SCAN", options.needed, "A record of this scan must be there; may be repeated.");
  check.option("--devices", "FILE", options.devices, "Refuse records made with devices of other serial numbers.");
  cli::add_printer(check, options.printer);
}

bool is_scan(const std::string& command) { return command == "check" || scans().contains(command); }

void run_scan(const cli::App& app, const ScanOptions& given, const std::string& command) {
  ScanOptions options = given;
  options.command = command;
  model::Printer printer = io::load_printer(options.printer.file, options.printer.sets, io::Records::ignore);
  if (command == "check") return check_records(options, printer.calibration);
  // Where the axis stands in the camera's picture, as measured before.
  const auto axis_record = io::current_record(printer.calibration, "axis");
  if (axis_record && command != "axis" && io::objection(*axis_record, printer.calibration, io::utc_seconds()).empty()) {
    printer.camera.axis_column = axis_record->value("axis_column");
  }
  // A latency that was measured before helps to tell which picture a frame shows.
  const auto known = io::current_record(printer.calibration, "latency");
  if (known && command != "latency" && io::objection(*known, printer.calibration, io::utc_seconds()).empty()) {
    printer.projector.latency_ms = known->value("latency");
  }
  if (options.from.empty()) throw Error{Fault::usage, command + ": no frames; name them with --from"};
  keep(app, options, printer.calibration, command, scans().at(command)(options, printer));
}

}  // namespace vam::capture_tool
