// vam-sim-camera: a GigE Vision camera that looks at a simulated vial, on a network address of this machine.
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
#include "io/picture/any_frames.hpp"
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
          {"Behaves like a GenICam camera on GigE Vision, on a network address of this machine: it prints that address "
           "when it is ready, and answers any GenICam client until a signal ends it. It looks at a simulated vial, "
           "which refracts: the print in it scatters and grows with the light it got, and what the projector shows "
           "glows in the resin.",
           "The vial turns as the log of vam-sim-stage says (--angles), or at a steady --speed. The projector shows "
           "what the log of vam-project says (--shown), and its light makes the print grow: the test pattern that the "
           "log names, else the frames of --frames or --pattern. Without that log the first of them is shown all the "
           "time. A frame shows its whole exposure, be the picture another meanwhile.",
           "Its own log tells what it truly sent, to judge the tools by: for every frame its number, the angle, the "
           "seconds of light so far and a fingerprint of its grey levels, which the manifest of vam-capture has, too.",
           "An address has one camera at a time: GigE Vision's control port is always 3956."},
          {{"A camera, asked who it is",
            "vam-sim-camera --die-with-parent >address & sleep 1; vam-capture identify --device aravis:127.0.0.1"}},
          {"Faults. --lose and --cut name frames, counted from the first one sent, of which no packet arrives, or only "
           "some. --vanish N pulls the cable before frame N: the program ends without a word to its client. "
           "--shrink N sends pictures half as high as agreed from frame N on, until a client sets the size again. The "
           "bench "
           "itself may be out of adjustment; the options of that group are what vam-capture's scans have to find.",
           "The fake camera of Aravis, which serves, keeps up with about 50 frames of 0.3 megapixels a second."},
          {"vam-capture", "vam-sim-stage", "vam-project"},
          {},
          cli::device_statuses};
}

void declare(cli::App& app, Options& o) {
  auto& bench = o.camera.bench;
  app.group("The scene");
  app.option("--part", "BODIES", o.part, "The print, like 'sphere:x=2,diameter=4;cylinder:diameter=6,height=3'.");
  app.option("--lit", "S", bench.lit_s, cli::positive, "Light that makes the print; its volume grows in proportion.");
  app.option("--angles", "FILE", o.camera.sources.angles, "Log of vam-sim-stage: the true angle of the table.");
  app.option("--speed", "DEG/S", o.camera.sources.speed_deg_s, {-1000, 1000}, "Of the table, without --angles.");
  app.option("--shown", "FILE", o.camera.sources.shown, "Log of vam-project: which frame was on when.");
  app.option("--frames", "FILE", o.frames, "What vam-project shows: an EXR frame stack, video or folder of pictures.");
  app.option("--pattern", "NAME", o.pattern.name, "What vam-project shows: a test pattern.");
  app.option("--pitch", "PX", o.pattern.pitch_px, {1, 100000}, "Of the pattern.");
  app.option("--width", "PX", o.pattern.width_px, {1, 100000}, "Of the pattern's lines.");
  app.option("--level", "PART", o.pattern.level, {0, 1}, "Of the pattern's light.");
  app.option("--steps", "N", o.pattern.steps, {2, 65536}, "Of the pattern ramp.");
  app.group("The bench, out of adjustment");
  app.option("--axis-column", "PX", bench.axis_column, {-4096, 4096},
             "Of the rotation axis, from the sensor's middle.");
  app.option("--tilt", "DEG", bench.tilt_deg, {-30, 30}, "Lean of the axis, its lower end towards higher columns.");
  app.option("--centre", "PX", bench.centre_px, {-4096, 4096},
             "Of the vial in the projector's columns, from projector.axis_column.");
  app.option("--wobble", "MM", bench.wobble_mm, {0, 100}, "Distance of the vial's axis from the table's.");
  app.option("--wobble-phase", "DEG", bench.wobble_deg, {-360, 360},
             "Stage angle at which it stands towards the projector's higher columns.");
  app.option("--beam", "MM", bench.beam_mm, {0, 10}, "Blur of a pixel in focus: full width at half maximum.");
  app.option("--focus", "MM", bench.focus_mm, {-1000, 1000}, "Where that is, along the light, from the axis.");
  app.option("--divergence", "DEG", bench.divergence_deg, {0, 45},
             "Growth of that width with the distance from there.");
  app.flag("--card", bench.card, "An even card stands in the vial's place; the picture's mean lights it.");
  app.option("--glow", "PART", bench.glow, {0, 10000},
             "Brightness of a vial that is lit all over, of full scale in 20 ms. A thin line needs more.");
  app.option("--gamma", "N", bench.gamma, {0.1, 10}, "Light = (grey / full) to this power.");
  app.option("--vignetting", "PART", bench.vignetting, {0, 1}, "Light that the image's corners lack.");
  app.option("--background", "PART", bench.background, {0, 1}, "Of full scale.");
  app.option("--noise", "PART", bench.noise, {0, 1}, "Standard deviation, of full scale.");
  app.option("--lag", "MS", o.lag_ms, {-1000, 1000}, "From what a frame shows to its time stamp.");
  app.group("The camera");
  app.option("--address", "IP", o.address, "Where it is served: an address of this machine.");
  app.option("--serial", "TEXT", o.serial, "Its serial number.");
  app.option("--columns", "PX", bench.columns, {8, 2048}, "Of the sensor, camera.pixel_mm apart.");
  app.option("--rows", "PX", bench.rows, {8, 2048}, "Of the sensor.");
  app.group("Faults");
  app.option("--lose", "FRAMES", o.lose, "Frames that never arrive, like 3,7.");
  app.option("--cut", "FRAMES", o.cut, "Frames that arrive in part.");
  app.option("--vanish", "N", o.vanish, {0, 1e9}, "Unplugged before this frame.");
  app.option("--shrink", "N", o.shrink, {1, 1e9}, "From this frame on, pictures half as high as agreed.");
  app.group("The program");
  app.option("--seed", "N", bench.seed, {0, 1e9}, "Of the random numbers.");
  app.option("--log", "FILE", o.log, "Append what happens, one JSON line an event.");
  app.flag("--die-with-parent", o.with_parent, "End when the process that started this one ends.");
  cli::add_printer(app, o.printer);
}

std::vector<GreyImage> read_pictures(const std::string& path) {
  const auto source = io::open_images(path, io::file_type(path));
  std::vector<GreyImage> pictures;
  Image image;
  model::ImageInfo about;
  while (source->next(image, about)) {
    GreyImage& picture = pictures.emplace_back(image.width, image.height, 8);
    for (std::size_t i = 0; i < image.size(); ++i) {
      picture.values[i] = static_cast<std::uint16_t>(std::lround(255 * std::clamp(image.values[i], 0.0F, 1.0F)));
    }
  }
  return pictures;
}

std::vector<GreyImage> pictures(const optics::PatternPlan& pattern, const model::Projector& projector) {
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

std::vector<GreyImage> pictures(const Options& o, const model::Projector& projector) {
  if (!o.frames.empty() && !o.pattern.name.empty()) {
    throw Error{Fault::usage, "--frames: the projector shows --pattern already; give one of the two"};
  }
  if (!o.frames.empty()) {
    auto read = read_pictures(o.frames);
    for (const auto& picture : read) {
      if (picture.width == projector.columns && picture.height == projector.rows) continue;
      throw Error{Fault::data, o.frames + ": frames of " + std::to_string(picture.width) + " x " +
                                   std::to_string(picture.height) + " pixels, but the projector has " +
                                   std::to_string(projector.columns) + " x " + std::to_string(projector.rows)};
    }
    return read;
  }
  return o.pattern.name.empty() ? std::vector<GreyImage>{} : pictures(o.pattern, projector);
}

void run(Options& o) {
  if (tool::print_printer(o.printer)) return;
  if (o.with_parent) device::end_with_parent();
  auto& camera = o.camera;
  camera.bench.printer = tool::load_printer(o.printer);
  if (!o.part.empty()) camera.bench.bodies = sim::parse_bodies(o.part);
  camera.sources.pictures = pictures(o, camera.bench.printer.projector);
  camera.sources.draw = [&camera](const Json& event) {
    return pictures(pattern_of(event), camera.bench.printer.projector);
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
