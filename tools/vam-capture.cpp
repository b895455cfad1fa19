// SPDX-License-Identifier: GPL-3.0-or-later
// vam-capture: captures the camera's frames, each with its time and the angle of the stage.
#include <string>
#include <vector>

#include "cli/app.hpp"
#include "device/open/open.hpp"
#include "device/os/event_log.hpp"
#include "device/os/interrupt.hpp"
#include "manual_page.hpp"
#include "model/device_schemes.hpp"
#include "session/printer.hpp"
#include "vam-capture/session.hpp"

namespace {

using namespace vam;
using capture_tool::Options;

void add_camera(cli::App& app, Options& o, const std::string& heading) {
  app.group(heading);
  app.option("--device", "DEVICE", o.device, "Camera: " + model::forms_of(model::camera_schemes) + ".")
      .default_is("camera.device");
  app.group(heading, {}, {"recordings"});
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
  const std::vector<std::string> folders{"folders"};
  cli::add_output(app, o.output).writes_as({".exr"});
  add_camera(app, o, "Camera");
  app.group("Frame selection");
  app.option("--frames", "N", o.frames, {1, 1e6},
             "Number of frames. Required for a stack unless --live or --view-step is given.")
      .default_is("until a signal or the end of a recording, for a folder or with --live")
      .form();
  app.option("--view-step", "DEG", o.every_deg, cli::positive,
             "Angle between the frames to keep: those nearest to its multiples.")
      .default_is("every frame is kept");
  app.option("--turns", "N", o.turns, cli::positive, "Number of turns.")
      .default_is("1")
      .only_with({"--view-step"})
      .excludes({"--frames"});
  app.option("--follow", "FILE", o.follow, "Read the stage angle from this output of vam-stage, a FIFO or -.");
  app.option("--speed", "DEG/S", o.speed_deg_s, cli::rate, "Stage speed; the angle is speed x time since the start.")
      .excludes({"--follow"});
  app.option("--angle", "DEG", o.angle_deg, {0, 1e6}, "Fixed stage angle.")
      .excludes({"--follow", "--speed", "--view-step"});
  app.option("--lag", "MS", o.lag_ms, {-10000, 10000},
             "Delay of the camera's time stamps from the moment of the exposure that they name (camera.stamp).")
      .default_is("camera.lag_ms");
  app.option("--max-lost", "N", o.max_lost, cli::non_negative,
             "Maximum number of dropped and incomplete frames; above it the capture ends with status 75.");
  app.group("Output and performance");
  app.flag("--live", o.live, "Send every frame immediately as a stack of its own.").form().not_for(folders);
  app.option("--latest", "FILE", o.latest, "Also write the newest frame to FILE (PNG), at most once a second.")
      .writes_as({".png"});
  app.option("--pixel", "MM", o.pixel_mm, cli::positive,
             "Pixel pitch of the frames at the axis, after the camera's binning.")
      .default_is("camera.pixel_mm times the binning");
  cli::add_printer(app, o.printer);
  app.group("Stack", {}, folders);
  cli::add_stack_output(app, o.stack.half, o.stack.compression);
  app.group(cli::App::plain_heading);
  app.option("--log", "FILE", o.log,
             "Append one JSON line per event, with UTC and monotonic time; - is standard error.");
  app.flag("--die-with-parent", o.with_parent, "Exit when the parent process exits.");
  cli::add_report(app, o.report);
  cli::App& who = app.subcommand("identify", "print the camera, its settings and its firmware as JSON", [&app, &o] {
    if (!session::print_printer(o.printer)) device::interruptible([&] { capture_tool::identify(app, o); });
  });
  add_camera(who, o, cli::App::plain_heading);
  cli::add_printer(who, o.printer);
  app.usual({"--output", "--log", "--device", "--exposure", "--fps", "--gain", "--trigger", "--frames", "--view-step",
             "--turns", "--follow", "--live", "--printer", "--set", "--report"});
}

void run(const cli::App& app, const Options& options) {
  if (session::print_printer(options.printer)) return;
  device::interruptible([&] {
    if (options.with_parent) device::end_with_parent();
    device::logged(options.log, [&] { capture_tool::take(app, options); });
  });
}

}  // namespace

int main(int argc, char** argv) {
  cli::App app(
      {"vam-capture", "capture camera frames with their times and stage angles", manual_page, cli::device_statuses});
  Options options;
  declare(app, options);
  return app.run(argc, argv, [&] { run(app, options); });
}
