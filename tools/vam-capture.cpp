// SPDX-License-Identifier: GPL-3.0-or-later
// vam-capture: captures the camera's frames, each with its time and the angle of the stage.
#include <string>
#include <vector>

#include "cli/app.hpp"
#include "device/open/camera.hpp"
#include "device/os/event_log.hpp"
#include "device/os/interrupt.hpp"
#include "printer.hpp"
#include "vam-capture/session.hpp"

namespace {

using namespace vam;
using capture_tool::Options;

std::vector<std::string> description() {
  return {
      "Captures frames of the camera beside the vial. Each frame carries its time on CLOCK_MONOTONIC, which all "
      "processes of the machine share, and, with --follow, the angle of the stage at that time, from the output of "
      "vam-stage spin or follow. Pixel values are fractions of full scale.",
      "The output name selects the format. A name in .exr is a frame stack of --frames images, and so is standard "
      "output; with --live every frame is sent immediately as a stack of its own, for vam-ost --live. A name without "
      "an extension, or ending in /, is a folder of numbered PNG files with manifest.jsonl: a frame is on the disk "
      "before its line of the manifest is. Repeating the command captures only the missing frames, names them in a "
      "warning, and is refused (73) with other settings.",
      "Every frame is kept by default; in a folder the number of a lost frame is left out. With --view-step DEG the "
      "frame nearest to each multiple of that angle is kept, for --turns turns from angle 0; with --speed, an angle is "
      "refused of which these frames would be further apart than vam-ost allows (15 degrees).",
      "The camera is that of --device or camera.device in the printer file; without either the command fails. Frames "
      "of a simulated camera are marked: \"simulated\" in log, report and manifest, and a line in the history of a "
      "stack.",
      "A device is a scheme, a place and options. aravis:IP-or-ID is a GenICam camera on USB3 Vision or GigE Vision "
      "(?packet_size=8000, ?buffers=20); aravis: without a name is the only camera connected. v4l2:/dev/video0 is a "
      "Video4Linux "
      "camera. replay:PLACE is a folder of vam-capture, a folder of numbered images or an EXR frame stack, read as "
      "fast as possible, or with ?pace=real in real time. sim: is a vial with a growing print, simulated in the tool; "
      "its options are those of vam-sim-camera(1) on scene, misalignment, projector, sensor and faults, with "
      "underscores (?lit=0.1&wobble_phase=30, card=1 for a flag), and pace=virtual, which does not wait for real time; "
      "the projected image is that of flips.",
      "Lost frames are always reported: the numbers of dropped and of incomplete frames appear on standard error, in "
      "--report and in --log. An incomplete frame is marked in the manifest and in the stack (vam:incomplete); the "
      "received part is stored, and vam-ost skips the frame. A gap in vam:number means dropped frames."};
}

std::vector<std::string> notes() {
  return {
      "Settings. Exposure, frame rate and binning default to the printer file's [camera]; every setting is read back, "
      "and a camera that applies another value ends the capture (status 76). Automatic exposure, gain, black level, "
      "gamma and white balance are switched off, and gamma is set to 1, so that grey levels are proportional to "
      "intensity. The settings in force are recorded in log, report and manifest (gain, gamma, black_level, "
      "automatic_off).",
      "Time. The time of a frame is the middle of its exposure. It is determined from the camera's time stamp, the "
      "moment of the exposure that the stamp names (camera.stamp), the camera's clock, which is read every second, "
      "and --lag. Where that clock cannot be read, stamps are converted by the shortest delay observed in the last "
      "10 s.",
      "Faults. A camera that stops sending frames is queried once: the status is 75 if it answers and 69 if it is "
      "disconnected, within --timeout plus 5 s.",
      "A device has one user at a time: a second one exits with status 75 and names the process that holds it.",
      "Protocols and fault handling of the devices are described in vam-devices(7)."};
}

cli::Manual manual() {
  return {
      "vam-capture",
      "capture camera frames with their times and stage angles",
      description(),
      {{"Identify the camera, here a simulated one:", "vam-capture identify --device sim:"},
       {"Twenty frames of a simulated print, 18 degrees apart, as fast as they can be rendered:",
        "vam-capture --device 'sim:?pace=virtual&speed=180&lit=0.1' --binning 8 --fps 10 --frames 20 -o "
        "views.exr"},
       {"A turn of views into a folder, whose second call finds nothing missing and captures nothing; and what they "
        "show:",
        "vam-capture --device 'sim:?pace=virtual&speed=90&lit=0' --binning 8 --fps 10 --speed 90 --view-step 9 -o "
        "views/\nvam-capture "
        "--device 'sim:?pace=virtual&speed=90&lit=0' --binning 8 --fps 10 --speed 90 --view-step 9 -o views/\n"
        "vam-ost views -o print.vdb"}},
      notes(),
      {"vam-calibrate", "vam-sim-camera", "vam-stage", "vam-project", "vam-ost"},
      {"In addition to the attributes of all frame stacks, every image of a captured stack has vam:time_s (seconds on "
       "CLOCK_MONOTONIC, the middle of the exposure), vam:time_sigma_s (its standard deviation by the readings of the "
       "camera's clock, shared by all frames), vam:angle_deg (degrees, where the angle of the stage is known), "
       "vam:number (integer, counts the camera's frames from 0; a gap means dropped frames) and, where parts of the "
       "frame were not received, vam:incomplete (1).",
       "A folder's manifest.jsonl begins with a line on the camera and its settings. A line for each frame follows "
       "when its image is on the disk: frame (its index), file, number, t_monotonic_s, time_sigma_s, device_s (the "
       "camera's own "
       "stamp), angle_deg, sigma_deg, complete and levels (a fingerprint of the grey levels); dropped frames have a "
       "line {\"dropped\":[FIRST,LAST]}, and the last line states how many frames there are. Every line is sealed "
       "together with the one above: images and lines that were changed, exchanged, added or lost are refused (65) by "
       "all tools that read the folder, and by a capture that completes it; vam-check(1) verifies it. An image that "
       "was deleted is captured again."},
      cli::device_statuses};
}

void add_camera(cli::App& app, Options& o) {
  app.option("--device", "DEVICE", o.device, "Camera: " + device::camera_devices() + ".").default_is("camera.device");
  app.option("--exposure", "US", o.camera.exposure_us, cli::positive, "Exposure time.")
      .default_is("camera.exposure_us");
  app.option("--fps", "HZ", o.camera.fps, cli::rate, "Frames per second.").default_is("camera.fps");
  app.option("--binning", "N", o.camera.binning, {1, 64}, "Binning by the camera: the sum of N x N pixels.")
      .default_is("camera.binning");
  app.option("--gain", "VALUE", o.camera.gain, cli::any, "Gain, in dB or in steps of the camera.")
      .default_is("camera.gain, else unchanged");
  app.option("--black-level", "VALUE", o.camera.black_level, cli::any, "Black level, in the unit of the camera.")
      .default_is("camera.black_level, else unchanged");
  app.option("--gamma", "N", o.camera.gamma, {0.1, 10}, "Gamma of the camera; 1 is linear.");
  app.option("--trigger", "SOURCE", o.camera.trigger,
             "Trigger source: free (none), software, or an input line of the camera (Line0).");
  app.option("--format", "NAME", o.camera.format,
             "Pixel format, by the camera's name for it (Mono8, Mono16, GREY, Y16).");
  app.option("--timeout", "S", o.camera.timeout_s, {0.01, 86400}, "Maximum time to wait for a frame.")
      .default_is("three frame periods, an exposure and one second");
}

void declare(cli::App& app, Options& o) {
  cli::add_output(app, o.output);
  app.group("Camera");
  add_camera(app, o);
  app.group("Frame selection");
  app.option("--frames", "N", o.frames, {1, 1e6},
             "Number of frames. Required for a stack unless --live or --view-step is given.")
      .default_is("until a signal or the end of a recording, for a folder or with --live")
      .form();
  app.option("--view-step", "DEG", o.every_deg, cli::positive,
             "Angle between the frames to keep: those nearest to its multiples.")
      .default_is("every frame is kept");
  app.option("--turns", "N", o.turns, cli::positive, "With --view-step: number of turns.").default_is("1");
  app.option("--follow", "FILE", o.follow, "Read the stage angle from this output of vam-stage, a FIFO or -.");
  app.option("--speed", "DEG/S", o.speed_deg_s, cli::rate,
             "Without --follow: stage speed; the angle is speed x time since the start.");
  app.option("--angle", "DEG", o.angle_deg, {0, 1e6}, "Without --follow: fixed stage angle.");
  app.option("--lag", "MS", o.lag_ms, {-10000, 10000},
             "Delay of the camera's time stamps from the moment of the exposure that they name (camera.stamp).")
      .default_is("camera.lag_ms");
  app.option("--max-lost", "N", o.max_lost, cli::non_negative,
             "Maximum number of dropped and incomplete frames; above it the capture ends with status 75.");
  app.group("Output and performance");
  app.flag("--live", o.live, "Send every frame immediately as a stack of its own.").form();
  app.option("--latest", "FILE", o.latest, "Also write the newest frame to FILE (PNG), at most once a second.")
      .writes_as({".png"});
  app.option("--pixel", "MM", o.pixel_mm, cli::positive,
             "Pixel pitch of the frames at the axis, after the camera's binning.")
      .default_is("camera.pixel_mm times the binning");
  cli::add_printer(app, o.printer);
  cli::add_stack_output(app, o.stack.half, o.stack.compression);
  app.option("--log", "FILE", o.log,
             "Append one JSON line per event, with UTC and monotonic time; - is standard error.");
  app.flag("--die-with-parent", o.with_parent, "Exit when the parent process exits.");
  cli::add_report(app, o.report);
  cli::App& who = app.subcommand("identify", "print the camera, its settings and its firmware as JSON", o.command);
  add_camera(who, o);
  cli::add_printer(who, o.printer);
  app.usual({"--output", "--log", "--device", "--exposure", "--fps", "--gain", "--trigger", "--frames", "--view-step",
             "--turns", "--follow", "--live", "--printer", "--set", "--report"});
}

void run(const cli::App& app, const Options& options) {
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
  declare(app, options);
  return app.run(argc, argv, [&] { run(app, options); });
}
