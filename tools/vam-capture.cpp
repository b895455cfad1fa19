// vam-capture: takes the camera's frames, each with its time and the angle of the stage.
#include <cmath>
#include <string>

#include "base/error.hpp"
#include "base/log.hpp"
#include "cli/app.hpp"
#include "device/os/event_log.hpp"
#include "device/os/interrupt.hpp"
#include "printer.hpp"
#include "vam-capture/scan.hpp"
#include "vam-capture/session.hpp"

namespace {

using namespace vam;
using capture_tool::Options;

cli::Manual manual() {
  return {
      "vam-capture",
      "take camera frames with their times and stage angles",
      {"Takes frames of the camera beside the vial. Each carries its time on CLOCK_MONOTONIC, which all processes of "
       "the machine share, and, with --follow, the angle of the stage at that time, from the lines of vam-stage spin "
       "or follow. Pixels are fractions of full scale.",
       "The name of the output chooses the form. A name in .exr is a frame stack of --frames images, and so is "
       "standard output; with --live every frame is sent as a stack of its own as soon as it is there, for vam-ost "
       "--live. A name without an ending, or that ends in /, is a folder of numbered PNG files with manifest.jsonl: a "
       "frame is on the disk before its line in the manifest is. The same command again takes only the frames that are "
       "missing there.",
       "Without --every, frames are taken as they come; in a folder, a frame that was lost leaves its number free. "
       "With --every DEG the frame nearest to each multiple of that angle is kept, over --turns turns from angle 0.",
       "A device is a scheme, a place and options. aravis:IP-or-ID is a GenICam camera on USB3 Vision or GigE Vision "
       "(?packet_size=8000, ?buffers=20); aravis: the only one there is. v4l2:/dev/video0 is a Video4Linux camera. "
       "replay:PLACE is a folder of vam-capture, a folder of numbered pictures or an EXR frame stack, as fast as it "
       "can be read, or with ?pace=real in step. sim: is a vial with a growing print, simulated in the tool; its "
       "options are those of vam-sim-camera(1), with underscores, and pace=virtual.",
       "The scans edges, response, flat, beam, axis and latency read frames that were captured while vam-project "
       "showed a test pattern, and what its --log says was on when (--flips), and write a calibration record; check "
       "says which records are in force. vam-calibrate(1) runs them all. For edges the whole vial must be in the "
       "picture, of a camera where camera.distance_mm and camera.azimuth_deg say, 60 to 91 degrees from the projector. "
       "The beam is seen on a bare sensor "
       "that is moved along the light, one frame a plane, or, with --side, by the camera beside the vial while one row "
       "is lit: each column of its picture is another plane of the resin.",
       "A record is a JSON file in calibration.folder of the printer file: read-only, named "
       "cal-INSTRUMENT-SCAN-UTC.json, with each value's unit, sigma, number of readings and method, the hashes of the "
       "frames, how long it is valid and for which instrument and vial. The link current-SCAN.json points to the one "
       "in force, which every tool that reads the printer file takes up: flag, then --set, then record, then file. A "
       "stale or foreign record is refused (status 65). A scan whose result is not to be trusted is recorded, but not "
       "put in force (status 1). Without a folder the record goes to standard output. The latency takes the "
       "frames' times as true: find the capture's --latency first.",
       "Lost frames are never hidden: the count of frames that were dropped and of those that came incomplete is said "
       "on standard error, in --report and in --log; an incomplete frame is marked in the manifest and in the stack "
       "(vam:incomplete), where it keeps the parts that came, and vam-ost leaves it out. A gap in vam:number is frames "
       "that were dropped."},
      {{"Which camera is it?", "vam-capture identify"},
       {"Twenty frames of a simulated print that turns 18 degrees between two of them, as fast as they can be made:",
        "vam-capture --device 'sim:?pace=virtual&speed_deg_s=180&lit_s=0.1' --binning 8 --fps 10 --frames 20 -o "
        "views.exr"},
       {"Where the rotation axis is in frames of a bead (here a piece of print) over a turn:",
        "vam-capture --device 'sim:?pace=virtual&speed_deg_s=90&lit_s=0.01&part=cylinder:x=2,diameter=1.5,height=6' "
        "--binning 4 --speed 90 --every 10 -o turn.exr && vam-capture axis --from turn.exr --bands 3"},
       {"Half a turn into a folder; the second call finds nothing missing and takes nothing:",
        "vam-capture --device 'sim:?pace=virtual' --binning 8 --speed 90 --every 12 --turns 0.5 -o views/\nvam-capture "
        "--device 'sim:?pace=virtual' --binning 8 --speed 90 --every 12 --turns 0.5 -o views/"}},
      {"Settings. Exposure, frame rate and binning that are not given are those of the printer file's [camera]; every "
       "one is read back, and a camera that does something else ends the capture (status 76).",
       "Time. The time of a frame is the middle of its exposure: the camera's own time stamp, carried over to the "
       "machine's clock by the shortest delay seen in the last 10 s, less half the exposure, less --latency, what the "
       "shortest way takes from the end of an exposure.",
       "A camera that falls silent is asked once more: status 75 when it answers, 69 when it is gone, within the "
       "time-out plus 5 s.",
       "A device has one user at a time: the second one exits with status 75 and names the process that has it."},
      {"vam-calibrate", "vam-sim-camera", "vam-stage", "vam-project", "vam-ost"},
      {"Beside what all frame stacks have, every image of a captured stack has the attributes vam:time_s (seconds on "
       "CLOCK_MONOTONIC, the middle of the exposure), vam:angle_deg (degrees, where the stage's angle is known), "
       "vam:number (whole number, counts the frames that the camera made from 0 on; a gap is frames that were dropped) "
       "and, where parts of the frame did not arrive, vam:incomplete (1).",
       "A folder's manifest.jsonl begins with a line about the camera and its settings. A line for each frame follows "
       "when its picture is on the disk: frame (its place), file, number, t_monotonic_s, device_s (the camera's own "
       "stamp), angle_deg, sigma_deg, complete and levels (a fingerprint of the grey levels); a line "
       "{\"dropped\":[FIRST,LAST]} for frames that never came."}};
}

void add_camera(cli::App& app, Options& o) {
  app.option("--device", "DEVICE", o.device, "The camera; without it camera.device.");
  app.option("--exposure", "US", o.camera.exposure_us, cli::positive, "Without it camera.exposure_us.");
  app.option("--fps", "HZ", o.camera.fps, cli::positive, "Frames a second; without it camera.fps.");
  app.option("--binning", "N", o.camera.binning, {1, 64}, "Sum N x N pixels in the camera; without it camera.binning.");
  app.option("--trigger", "SOURCE", o.camera.trigger, "free, software, or an input line of the camera (Line0).");
  app.option("--format", "NAME", o.camera.format, "Pixel format, as the camera calls it (Mono8, Mono16, GREY, Y16).");
  app.option("--timeout", "S", o.camera.timeout_s, {0.01, 86400},
             "Longest wait for a frame; without it a second more than three frames and an exposure take.");
}

void declare(cli::App& app, Options& o, capture_tool::ScanOptions& scans) {
  cli::add_output(app, o.output);
  app.group("Camera");
  add_camera(app, o);
  app.group("Which frames");
  app.option("--frames", "N", o.frames, {1, 1e6}, "How many. Without it, until a signal or the end of a recording.");
  app.option("--every", "DEG", o.every_deg, cli::positive, "Keep the frames nearest to the multiples of this angle.");
  app.option("--turns", "N", o.turns, cli::positive, "With --every: turns to take; 1 unless given.");
  app.option("--follow", "FILE", o.follow, "Take the stage's angle from these lines of vam-stage, a FIFO or -.");
  app.option("--speed", "DEG/S", o.speed_deg_s, cli::positive,
             "Without --follow: angle = speed x time since the start.");
  app.option("--latency", "MS", o.latency_ms, {-10000, 10000},
             "From the end of an exposure to the camera's time stamp, as it gets here.");
  app.option("--max-lost", "N", o.max_lost, cli::non_negative,
             "End with status 75 when more frames are dropped or incomplete.");
  app.group("Output and machine");
  app.flag("--live", o.live, "Send every frame at once as a stack of its own.");
  app.option("--pixel", "MM", o.pixel_mm, cli::positive,
             "Pitch at the axis, as binned; without it camera.pixel_mm times the binning.");
  cli::add_printer(app, o.printer);
  cli::add_stack_output(app, o.stack.half, o.stack.compression);
  app.option("--log", "FILE", o.log, "Append one JSON line per event, with UTC and monotonic time.");
  app.flag("--die-with-parent", o.with_parent, "End when the process that started this one ends.");
  cli::add_report(app, o.report);
  cli::App& who = app.subcommand("identify", "print the camera, its settings and its firmware as JSON", o.command);
  add_camera(who, o);
  cli::add_printer(who, o.printer);
  capture_tool::add_scans(app, scans, o.command);
}

void run(const cli::App& app, const Options& options, const capture_tool::ScanOptions& scans) {
  if (capture_tool::is_scan(options.command)) return capture_tool::run_scan(app, scans, options.command);
  if (tool::print_printer(options.printer)) return;
  device::interruptible([&] {
    if (options.with_parent) device::end_with_parent();
    if (options.command == "identify") return capture_tool::identify(options);
    device::logged(options.log, [&] { capture_tool::take(app, options); });
  });
}

}  // namespace

int main(int argc, char** argv) {
  cli::App app(manual());
  Options options;
  capture_tool::ScanOptions scans;
  declare(app, options, scans);
  return app.run(argc, argv, [&] { run(app, options, scans); });
}
