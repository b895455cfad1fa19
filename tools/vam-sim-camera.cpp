// vam-sim-camera: a GigE Vision camera that views a simulated vial, on a network address of this machine.
#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "base/json.hpp"
#include "cli/app.hpp"
#include "device/os/interrupt.hpp"
#include "device/port/lines.hpp"
#include "io/image/any_frames.hpp"
#include "optics/patterns.hpp"
#include "printer.hpp"
#include "sim/cameras/gv_camera.hpp"
#include "sim/controllers/options.hpp"

namespace {

using namespace vam;

struct Options {
  sim::SimCameraSettings camera;
  std::string address = "127.0.0.1";
  std::string serial = "VAM1";
  std::string part;
  std::string frames;
  optics::PatternPlan pattern;
  std::optional<int> pitch_px, width_px;  // its lines
  double lag_ms = 0;
  std::string lose, cut;
  std::optional<int> vanish, shrink;
  std::string log;
  cli::PrinterOptions printer;
  bool with_parent = false;
};

cli::Manual manual() {
  return {"vam-sim-camera",
          "simulate a GigE Vision camera beside the vial",
          {"Simulates a GenICam camera on GigE Vision, on a network address of this machine: it prints that address "
           "when it is ready, and serves any GenICam client until a signal ends it. It views a simulated, refracting "
           "vial: the print scatters and grows with its dose, and the projected image fluoresces in the resin.",
           "The vial turns according to the log of vam-sim-stage (--angles), or at a constant --speed. The projector "
           "shows the frames given by the log of vam-project (--flips), which also make the print grow: the test "
           "pattern named in the log, else those of --projected or --pattern. Without that log the first frame is "
           "shown all the time. A camera frame integrates over its whole exposure, also across changes of the image.",
           "Its own log is the reference for tests of the tools: for every frame its number, the angle, the exposed "
           "time so far in seconds and a fingerprint of its grey levels, which the manifest of vam-capture has, too.",
           "An address has one camera at a time: GigE Vision's control port is always 3956."},
          {{"Identify a simulated camera",
            "vam-sim-camera --die-with-parent >address & sleep 1; vam-capture identify --device aravis:127.0.0.1"}},
          {"Faults. --lose and --cut name frames, counted from the first one sent, of which no packet arrives, or only "
           "some. --vanish N disconnects the cable before frame N: the program ends without informing its client. "
           "--shrink N sends images of half the agreed height from frame N on, until a client sets the size again. The "
           "bench may be misaligned; the options of that group are the quantities measured by vam-calibrate.",
           "The camera server of Aravis sustains about 50 frames of 0.3 megapixels per second."},
          {"vam-capture", "vam-calibrate", "vam-sim-stage", "vam-project"},
          {},
          {{75, "The address has a camera already, or cannot serve one."}}};
}

void declare(cli::App& app, Options& o) {
  auto& bench = o.camera.bench;
  app.group("Scene");
  app.option("--part", "BODIES", o.part, "Print, like 'sphere:x=2,diameter=4;cylinder:diameter=6,height=3'.");
  app.option("--lit", "S", bench.lit_s, cli::non_negative,
             "Exposed time that completes the print; its volume grows in proportion. 0: it is there from the start.");
  app.option("--angles", "FILE", o.camera.sources.angles, "Log of vam-sim-stage: the true stage angle.");
  app.option("--speed", "DEG/S", o.camera.sources.speed_deg_s, {-1000, 1000}, "Stage speed without --angles.");
  app.option("--flips", "FILE", o.camera.sources.shown, "Log of vam-project: which frame was on and when.")
      .was("--shown");
  app.option("--projected", "FILE", o.frames,
             "Frames shown by vam-project: an EXR frame stack, video or folder of images.")
      .was("--frames");
  app.option("--pattern", "NAME", o.pattern.name, "Test pattern shown by vam-project.");
  app.option("--pitch", "PX", o.pitch_px, {1, 100000}, "Pitch of the pattern.").default_is("16; 4 for sweep");
  app.option("--width", "PX", o.width_px, {1, 100000}, "Width of the pattern's lines.").default_is("1; 4 for sweep");
  app.option("--grey", "FRACTION", o.pattern.level, {0, 1}, "Grey level of the pattern, as a fraction of full grey.")
      .was("--level");
  app.option("--steps", "N", o.pattern.steps, {2, 65536}, "Levels of the pattern ramp.");
  app.group("Misalignment of the bench");
  app.option("--axis-column", "PX", bench.axis_column, {-4096, 4096},
             "Column of the rotation axis, counted from the centre of the sensor (camera.axis_column counts from its "
             "left edge).");
  app.option("--tilt", "DEG", bench.tilt_deg, {-30, 30}, "Tilt of the axis, its lower end towards higher columns.");
  app.option("--centre", "PX", bench.centre_px, {-4096, 4096},
             "Centre of the vial in projector columns, from projector.axis_column.");
  app.option("--wobble", "MM", bench.wobble_mm, {0, 100}, "Distance between the axes of vial and stage.");
  app.option("--wobble-phase", "DEG", bench.wobble_deg, {-360, 360},
             "Stage angle at which the vial is displaced towards higher projector columns.");
  app.option("--beam", "MM", bench.beam_mm, {0, 10}, "Full width at half maximum of a pixel in focus.");
  app.option("--focus", "MM", bench.focus_mm, {-1000, 1000}, "Position of the focus along the beam, from the axis.");
  app.option("--divergence", "DEG", bench.divergence_deg, {0, 45},
             "Increase of that width with the distance from focus.");
  app.flag("--card", bench.card, "Uniform card in place of the vial, lit by the mean of the image.");
  app.option("--glow", "FRACTION", bench.glow, {0, 10000},
             "Fluorescence of a fully lit vial, as a fraction of full scale in 20 ms. A thin line needs more.");
  app.option("--gamma", "N", bench.gamma, {0.1, 10}, "Intensity = (grey / full grey) to this power.");
  app.option("--vignetting", "FRACTION", bench.vignetting, {0, 1},
             "Relative loss of intensity at the corners of the image.");
  app.option("--background", "FRACTION", bench.background, {0, 1}, "Background, as a fraction of full scale.");
  app.option("--noise", "FRACTION", bench.noise, {0, 1}, "Standard deviation of noise, as a fraction of full scale.");
  app.option("--lag", "MS", o.lag_ms, {-1000, 1000}, "Delay from exposure to time stamp.");
  app.group("Camera");
  app.option("--address", "IP", o.address, "Address of this machine to serve on.");
  app.option("--serial", "TEXT", o.serial, "Serial number.");
  app.option("--columns", "PX", bench.columns, {8, 2048}, "Sensor columns, at a pitch of camera.pixel_mm.");
  app.option("--rows", "PX", bench.rows, {8, 2048}, "Sensor rows.");
  app.group("Faults");
  app.option("--lose", "FRAMES", o.lose, "Frames that are lost, like 3,7.");
  app.option("--cut", "FRAMES", o.cut, "Frames that arrive incomplete.");
  app.option("--vanish", "N", o.vanish, {0, 1e9}, "Disconnect before this frame.");
  app.option("--shrink", "N", o.shrink, {1, 1e9}, "From this frame on, images of half the agreed height.");
  app.group("Program");
  app.option("--seed", "N", bench.seed, {0, 1e9}, "Seed of the random numbers.");
  app.option("--log", "FILE", o.log, "Append one JSON line per event.");
  app.flag("--die-with-parent", o.with_parent, "Exit when the parent process exits.");
  cli::add_printer(app, o.printer);
}

std::vector<GreyImage> read_images(const std::string& path) {
  const auto source = io::open_images(path, io::file_type(path));
  std::vector<GreyImage> images;
  Image image;
  model::ImageInfo about;
  while (source->next(image, about)) {
    GreyImage& grey = images.emplace_back(image.width, image.height, 8);
    for (std::size_t i = 0; i < image.size(); ++i) {
      grey.values[i] = static_cast<std::uint16_t>(std::lround(255 * std::clamp(image.values[i], 0.0F, 1.0F)));
    }
  }
  return images;
}

std::vector<GreyImage> images(const optics::PatternPlan& pattern, const model::Projector& projector) {
  std::vector<GreyImage> shown;
  for (int n = 0; n < optics::pattern_frames(pattern, projector); ++n) {
    shown.push_back(optics::pattern_frame(pattern, projector, n));
  }
  return shown;
}

// As vam-project --pattern logs it.
optics::PatternPlan pattern_of(const Json& event) {
  optics::PatternPlan plan;
  plan.name = event.value("name", plan.name);
  plan.level = event.value("level", plan.level);
  plan.pitch_px = event.value("pitch_px", plan.pitch_px);
  plan.width_px = event.value("width_px", plan.width_px);
  plan.steps = event.value("steps", plan.steps);
  return plan;
}

std::vector<GreyImage> images(const Options& o, const model::Projector& projector) {
  if (!o.frames.empty() && !o.pattern.name.empty()) {
    throw Error{Fault::usage, "--projected: conflicts with --pattern; give one of them"};
  }
  if (!o.frames.empty()) {
    auto read = read_images(o.frames);
    for (const auto& image : read) {
      if (image.width == projector.columns && image.height == projector.rows) continue;
      throw Error{Fault::data, o.frames + ": frames of " + std::to_string(image.width) + " x " +
                                   std::to_string(image.height) + " pixels, but the projector has " +
                                   std::to_string(projector.columns) + " x " + std::to_string(projector.rows)};
    }
    return read;
  }
  return o.pattern.name.empty() ? std::vector<GreyImage>{} : images(o.pattern, projector);
}

void run(Options& o) {
  if (tool::print_printer(o.printer)) return;
  optics::set_lines(o.pattern, o.pitch_px, o.width_px);
  if (o.with_parent) device::end_with_parent();
  auto& camera = o.camera;
  camera.bench.printer = tool::load_printer(o.printer);
  if (!o.part.empty()) camera.bench.bodies = sim::parse_bodies(o.part);
  camera.sources.images = images(o, camera.bench.printer.projector);
  camera.sources.draw = [&camera](const Json& event) {
    return images(pattern_of(event), camera.bench.printer.projector);
  };
  camera.lag_s = 1e-3 * o.lag_ms;
  camera.lose = sim::parse_frames(o.lose);
  camera.cut = sim::parse_frames(o.cut);
  camera.vanish = o.vanish.value_or(-1);
  camera.shrink = o.shrink.value_or(-1);
  const sim::SimGvCamera server(camera, o.address, o.serial, sim::file_sim_log(o.log));
  device::print_line(o.address);
  for (;;) device::real_clock().sleep_until(device::real_clock().now_s() + 3600);
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  options.pattern.name.clear();
  cli::App app(manual());
  declare(app, options);
  // A signal may end it as it is: nothing is to be made safe, and waiting for Aravis' threads can take for ever.
  return app.run(argc, argv, [&] { run(options); });
}
