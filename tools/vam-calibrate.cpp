// vam-calibrate: measures the instrument from captured frames and writes calibration records.
#include <string>

#include "cli/app.hpp"
#include "moved.hpp"
#include "vam-calibrate/scan.hpp"

namespace {

using namespace vam;
using calibrate_tool::ResinOptions;
using calibrate_tool::ScanOptions;

cli::Manual manual() {
  return {
      "vam-calibrate",
      "measure the instrument and write calibration records",
      {"Each command reads frames that vam-capture took while vam-project showed a test pattern, measures one property "
       "of the instrument and writes a calibration record. --flips names the log of vam-project, which records which "
       "pattern frame was on and when. check reports which records are in force. vam-calibrate-all(1) shows the "
       "patterns, captures the frames and runs lag, latency, response, axis and edges in order; flat and beam on "
       "request.",
       "edges: the camera must see the whole vial, from the position given by camera.distance_mm and "
       "camera.azimuth_deg, 60 to 91 degrees from the projector. Because of wobble, frames at one stage angle locate "
       "the vial, not the rotation axis; frames at four (vam-capture --angle 0, 90, 180, 270, "
       "their stacks one after the other in one file) give both, the wobble as the radius and the stage angle of "
       "greatest column. beam: either a bare sensor is moved along the beam, "
       "one frame per plane, or, with --side, the camera beside the vial sees one lit row in fluorescent resin, where "
       "each image column is another plane. latency relies on the times of the frames. lag, which therefore comes "
       "first, determines the delay of the camera's time stamps "
       "from a bead that turns with the stage at known angles, in both directions, captured with --lag 0 and the "
       "exposure in use. Its record is the --lag of vam-capture from then on.",
       "A frame of which more than 0.01 % of the pixels (and more than 3) are at full level is refused as "
       "over-exposed, with that fraction. vam-calibrate-all(1) then shortens the exposure and repeats the scan.",
       "resin determines the gelation threshold I_p in the scattering volume of a printed standard cylinder (vam-ost): "
       "the threshold at which its cross-section has the known diameter, from a mean over the height of the standard. "
       "Its record is the --resin of vam-ost and vam-sdf.",
       "A record is a JSON file in calibration.folder of the printer file: read-only, named "
       "cal-INSTRUMENT-SCAN-UTC.json, with the unit, standard deviation, number of readings and method of each value, "
       "the hashes of the frames, the validity period, the instrument and the vial. The link current-SCAN.json points "
       "to the record in force, which is used by every tool that reads the printer file; precedence: flag, --set, "
       "record, file. A stale or foreign record is refused (status 65). A result that does not meet its requirements "
       "is recorded but not put in force (status 1). Without a folder the record is written to standard output."},
      {{"The rotation axis in frames of a bead (here a printed piece) over one turn:",
        "vam-capture --device 'sim:?pace=virtual&speed=90&lit=0.01&part=cylinder:x=2,diameter=1.5,height=6' "
        "--binning 4 --speed 90 --every 10 -o turn.exr && vam-calibrate axis turn.exr --heights 3"},
       {"The records in force:", "vam-calibrate check --set calibration.folder=cal"}},
      {},
      {"vam-calibrate-all", "vam-capture", "vam-project", "vam-ost"},
      {},
      {{1, "A result does not meet its requirements and is not put in force."}}};
}

enum class Flips { none, optional, required };

void add_input(cli::App& scan, ScanOptions& o, Flips flips) {
  scan.positional("FRAMES", o.from, "EXR stack or folder of vam-capture, or a folder of images.", "--from").reads();
  if (flips != Flips::none) {
    scan.option("--flips", "FILE", o.flips, "Log of vam-project during the capture: which pattern frame was on.")
        .reads();
    flips == Flips::required ? scan.required() : scan.default_is("frame n shows pattern frame n");
  }
  scan.option("--devices", "FILE", o.devices,
              "JSON for the record, like {\"camera\": ...}: the output of identify for each device in use.");
  cli::add_printer(scan, o.printer);
}

void add_dark(cli::App& scan, ScanOptions& o) {
  scan.option("--dark", "FILE", o.dark, "Image or stack taken with the projector dark; its mean is subtracted.")
      .reads();
}

void add_resin(cli::App& resin, ResinOptions& o) {
  resin.positional("SCATTER", o.scatter, "Scattering volume of the standard (VDB).").reads();
  resin.option("-o,--output", "FILE.json", o.record, "Record for --resin; - is standard output.");
  resin.option("--diameter", "MM", o.diameter_mm, cli::positive, "Known diameter of the standard.");
  resin.option("--profile", "FILE.png", o.profile, "Profilometer height map of the standard, to measure its diameter.")
      .reads();
  resin.option("--profile-pixel", "MM", o.profile_pixel_mm, cli::positive, "Pixel pitch of the height map.");
}

void declare(cli::App& app, ScanOptions& o, ResinOptions& resin) {
  auto& edges = app.subcommand("edges", "axis, wobble, radius and tilt of the vial, from sweeps of lines", o.command);
  add_input(edges, o, Flips::optional);
  edges.option("--pitch", "PX", o.pitch_px, {1, 1000}, "Step of the sweep.");
  edges.option("--width", "PX", o.width_px, {1, 1000}, "Width of the swept line.");
  edges.option("--heights", "N", o.heights, {1, 100}, "Number of heights measured separately.").was("--bands");
  edges.flag("--accept", o.accept, "Accept a vial that moved or changed since the previous record.");
  auto& ramp = app.subcommand("response", "intensity by grey level, from a ramp of uniform levels", o.command);
  add_input(ramp, o, Flips::optional);
  ramp.option("--steps", "N", o.steps, {2, 65536}, "Levels of the ramp.");
  add_dark(ramp, o);
  auto& even = app.subcommand("flat", "flat field of the camera, from frames of a uniform scene", o.command);
  add_input(even, o, Flips::optional);
  add_dark(even, o);
  auto& line = app.subcommand(
      "beam", "width and divergence of the beam, on a sensor moved along it or from the side in resin", o.command);
  add_input(line, o, Flips::optional);
  line.flag("--side", o.side,
            "The frames show a lit row in fluorescent resin from the side (vam-project --pattern row).");
  add_dark(line, o);
  line.option("--first", "MM", o.first_mm, cli::any, "Distance of the first plane from the rotation axis.");
  line.option("--spacing", "MM", o.step_mm, cli::any, "Distance between planes; required without --side.")
      .was("--step");
  line.option("--pixel", "MM", o.pixel_mm, cli::non_negative,
              "Pixel pitch of the bare sensor, required without --side; with it that of the frames at the axis.")
      .default_is("that of the stack, with --side");
  auto& turn = app.subcommand("axis", "rotation axis and wobble in the camera's frames over a turn", o.command);
  add_input(turn, o, Flips::none);
  turn.option("--angle-step", "DEG", o.step_deg, cli::any, "Angular step of frames without recorded angles.")
      .was("--step");
  turn.option("--heights", "N", o.heights, {1, 100}, "Number of heights measured separately.").was("--bands");
  auto& late = app.subcommand("lag", "delay of the camera's time stamps, from a bead that turns both ways", o.command);
  add_input(late, o, Flips::none);
  late.positional("REVERSE", o.reverse, "The frames of a turn the other way (vam-stage spin --direction -1).",
                  "--reverse")
      .reads();
  late.option("--heights", "N", o.heights, {1, 100}, "Number of heights measured separately.").was("--bands");
  add_input(app.subcommand("latency", "delay from a flip to its light, from a blinking screen", o.command), o,
            Flips::required);
  auto& check = app.subcommand("check", "print the records in force as JSON; status 65 if one is not valid", o.command);
  check.option("--need", "SCANS", o.needed, "Require a record of each of these scans, separated by commas.");
  check.option("--devices", "FILE", o.devices, "Refuse records of devices with other serial numbers.");
  cli::add_printer(check, o.printer);
  add_resin(app.subcommand("resin", "gelation threshold, from a printed standard cylinder", o.command), resin);
}

void run(const cli::App& app, const ScanOptions& scan, const ResinOptions& resin) {
  scan.command == "resin" ? calibrate_tool::measure_resin(resin) : calibrate_tool::run_scan(app, scan);
}

}  // namespace

int main(int argc, char** argv) {
  const int moved = tool::follow_moved(
      argc, argv, {"--screen", "--light", "--scans", "--home", "--sweep-exposure", "--keep"}, "vam-calibrate-all");
  if (moved >= 0) return moved;
  cli::App app(manual());
  ScanOptions scan;
  ResinOptions resin;
  declare(app, scan, resin);
  return app.run(argc, argv, [&] { run(app, scan, resin); });
}
