// SPDX-License-Identifier: GPL-3.0-or-later
// vam-calibrate: measures the instrument from captured frames and writes calibration records.
#include <string>

#include "base/error.hpp"
#include "cli/app.hpp"
#include "io/stream/file_type.hpp"
#include "manual_page.hpp"
#include "vam-calibrate/scan.hpp"

namespace {

using namespace vam;
using calibrate_tool::Scan;
using calibrate_tool::ScanOptions;

enum class Flips { none, optional, required };

/// A scan of captured frames.
cli::App& add_scan(cli::App& app, ScanOptions& o, const std::string& name, const std::string& summary, Scan work,
                   Flips flips) {
  auto& scan = app.subcommand(name, summary, [&app, &o, name, work] { run_scan(app, name, work, o); });
  scan.positional("FRAMES", o.from, "EXR stack or folder of vam-capture, or a folder of images.").reads();
  if (flips != Flips::none) {
    scan.option("--flips", "FILE", o.flips, "Log of vam-project: which pattern frame was on and when.").reads();
    flips == Flips::required ? scan.required() : scan.default_is("frame n shows pattern frame n");
  }
  scan.option(
      "--devices", "FILE", o.devices,
      "Identities of the devices in use, for the record: a JSON object like {\"camera\": ...} of the outputs of "
      "identify.");
  cli::add_printer(scan, o.printer);
  return scan;
}

void add_dark(cli::App& scan, ScanOptions& o) {
  scan.option("--dark", "FILE", o.dark, "Image or stack recorded with the projector dark; its mean is subtracted.")
      .reads();
}

void add_heights(cli::App& scan, ScanOptions& o) {
  scan.option("--heights", "N", o.heights, {1, 100}, "Number of heights measured separately.");
}

void add_edges(cli::App& app, ScanOptions& o) {
  auto& scan = add_scan(app, o, "edges", "axis, wobble, radius and tilt of the vial, from sweeps of a line",
                        calibrate_tool::scan_edges, Flips::optional);
  scan.option("--pitch", "PX", o.pitch_px, {1, 1000}, "Step of the sweep.");
  scan.option("--width", "PX", o.width_px, {1, 1000}, "Width of the swept line.");
  add_heights(scan, o);
  scan.flag("--accept", o.accept, "Accept a vial that moved or changed since the previous record.");
}

void add_response(cli::App& app, ScanOptions& o) {
  auto& scan = add_scan(app, o, "response", "intensity by grey level, from a ramp of uniform levels",
                        calibrate_tool::scan_response, Flips::optional);
  scan.option("--steps", "N", o.steps, {2, 65536}, "Levels of the ramp.");
  add_dark(scan, o);
}

void add_flat(cli::App& app, ScanOptions& o) {
  auto& scan = add_scan(app, o, "flat", "flat field of the camera, from frames of a uniform scene",
                        calibrate_tool::scan_flat, Flips::optional);
  add_dark(scan, o);
}

void add_beam(cli::App& app, ScanOptions& o) {
  auto& scan =
      add_scan(app, o, "beam", "width and divergence of the beam, on a sensor moved along it or from the side in resin",
               calibrate_tool::scan_beam, Flips::optional);
  scan.flag("--side", o.side,
            "The frames show a lit row in fluorescent resin from the side (vam-project --pattern row).")
      .form()
      .excludes({"--first", "--spacing"});
  add_dark(scan, o);
  scan.option("--first", "MM", o.first_mm, cli::any,
              "Distance of the first plane behind the rotation axis, along the light.")
      .required_without("--side");
  scan.option("--spacing", "MM", o.step_mm, cli::not_zero, "Distance between planes.").required_without("--side");
  scan.option("--pixel", "MM", o.pixel_mm, cli::positive,
              "Pixel pitch of the bare sensor, or of the frames at the rotation axis (with --side).")
      .required_without("--side")
      .default_is("as stated in the stack, with --side");
}

void add_axis(cli::App& app, ScanOptions& o) {
  auto& scan = add_scan(app, o, "axis", "rotation axis and wobble in the camera's frames of a turn",
                        calibrate_tool::scan_axis, Flips::none);
  scan.option("--view-step", "DEG", o.step_deg, cli::not_zero, "Angle between frames without recorded angles.");
  add_heights(scan, o);
}

void add_delays(cli::App& app, ScanOptions& o) {
  auto& lag = add_scan(app, o, "lag", "delay of the camera's time stamps, from a bead turned in both directions",
                       calibrate_tool::scan_lag, Flips::none);
  lag.positional("REVERSE", o.reverse, "Frames of a turn in the opposite direction (vam-stage spin --direction -1).")
      .reads();
  lag.option(
         "--follow", "FILE", o.angles,
         "Read the stage angle from this output of vam-stage spin during both turns, concatenated: the angles of the "
         "frames are fitted to all of its samples, and the standard deviation includes theirs.")
      .reads()
      .default_is("the angles of the frames");
  add_heights(lag, o);
  add_scan(app, o, "latency", "delay of the projector from a flip to its light, from a blinking screen",
           calibrate_tool::scan_latency, Flips::required);
}

void add_registration(cli::App& app, ScanOptions& o) {
  auto& scan =
      app.subcommand("registration", "height, angle and scale of the camera in the projector's frame", [&app, &o] {
        if (!io::is_volume(o.from)) app.require_for("meshes", o.from);
        run_scan(app, "registration", calibrate_tool::scan_registration, o);
      });
  scan.positional("PRINT", o.from,
                  "Scattering volume of a print (vam-ost), as it stands in the vial, with --isovalue; or its mesh.")
      .reads();
  scan.option("--design", "FILE", o.design,
              "Volume of vam-slice from which it was printed, or mesh in the part's frame.")
      .reads()
      .required();
  scan.option("--isovalue", "VALUE", o.isovalue, cli::positive, "Value of the volume at the print's surface.")
      .default_is("required for a volume")
      .not_for({"meshes"});
  scan.option("--devices", "FILE", o.devices, "Identities of the devices in use, for the record.");
  cli::add_printer(scan, o.printer);
}

void add_check(cli::App& app, ScanOptions& o) {
  auto& check = app.subcommand("check", "print the records in force as JSON; status 65 if one is not valid",
                               [&o] { check_records(o); });
  check.option("--need", "SCANS", o.needed, "Scans whose records are required, separated by commas.");
  check.option("--devices", "FILE", o.devices,
               "Identities of the devices in use: records of devices with other serial numbers are refused.");
  cli::add_printer(check, o.printer);
}

void declare(cli::App& app, ScanOptions& o) {
  add_edges(app, o);
  add_response(app, o);
  add_flat(app, o);
  add_beam(app, o);
  add_axis(app, o);
  add_delays(app, o);
  add_registration(app, o);
  add_check(app, o);
  calibrate_tool::add_resin(app);
  calibrate_tool::add_working_curve(app);
  calibrate_tool::add_critical_dose(app);
  calibrate_tool::add_photodiode(app);
  calibrate_tool::add_cure_depth(app);
}

}  // namespace

int main(int argc, char** argv) {
  std::vector<cli::ExitStatus> statuses = cli::device_statuses;
  statuses.push_back({1, "A result does not meet its requirements and is not put in force."});
  statuses.push_back({137, "all: a tool was killed."});
  cli::App app({"vam-calibrate", "measure the instrument and write calibration records", manual_page, statuses});
  ScanOptions options;
  int status = 0;
  declare(app, options);
  calibrate_tool::add_all(app, status);
  const int refused = app.run(argc, argv);
  return refused != 0 ? refused : status;
}
