// vam-project: projector frames from sinograms, for files; one frame per time step of the turning stage.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "base/json.hpp"
#include "base/log.hpp"
#include "base/parallel.hpp"
#include "base/text.hpp"
#include "cli/app.hpp"
#include "cli/common.hpp"
#include "io/exr_stack.hpp"
#include "io/frame_sink.hpp"
#include "io/report.hpp"
#include "io/stream.hpp"
#include "live.hpp"
#include "optics/flatland.hpp"
#include "optics/frames.hpp"
#include "patterns.hpp"
#include "printer.hpp"
#include "vam-project/show.hpp"
#include "vam-project/slices.hpp"

namespace {

using namespace vam;

struct Options {
  std::string input = "-";
  std::string output = "-";
  std::optional<double> fps, print_speed_mm_h, speed_deg_s, turns, flatland_mm, peak;
  std::optional<int> bits;
  std::string orientation;
  double column_offset = 0;
  double row_offset = 0;
  double intensity = 1;
  cli::PrinterOptions printer;
  io::StackOptions stack;
  std::string report;
  tool::LiveOptions live;
  tool::PatternOptions pattern;
};

cli::Manual manual() {
  return {
      "vam-project",
      "turn sinograms into the frames that a projector shows",
      {"A sinogram stack has an image for each slice, with a row for each angle. A projector needs the transposition: "
       "an image for each moment, with a row for each slice. vam-project reads the stack of vam-resample and writes "
       "one frame for every frame period of the projector while the stage turns.",
       "The name of the output chooses the form. A name without an ending, or that ends in /, is a folder of numbered "
       "PNG files with an index frames.csv (file, time_s, angle_deg). A name in .mkv is lossless FFV1 video, which may "
       "be printed from. A name in .mp4 is H.264 video for looking at; it errs by up to 59 of 255 and must not be "
       "printed from. A name in .exr, or standard output, is an EXR frame stack with the wanted intensity as a "
       "fraction of full, quantised only when --bits is given.",
       "Live: an output of sdl:N is a window over screen N of the desktop, drm:HDMI-A-1 the connector itself by page "
       "flips (no desktop may run there), null: a dry run. One turn of frames is preloaded; then for every vertical "
       "blank the frame is shown that belongs to the table's angle in the middle of its showing. With --follow the "
       "angle is predicted from the lines of vam-stage spin: black before angle 0, black again after the last turn. "
       "Without it the angle is the speed times the time since the first frame. The run-up turn is a dry run: when "
       "vertical blanks are missed there, no light comes at all. The frames' size must be the screen's.",
       "Time: frame n is centred on time n / fps, when the stage stands at n x speed / fps; it is shown for one frame "
       "period around it. If the sinogram has as many angles as there are frames in a turn, every frame is one of its "
       "rows; otherwise it is interpolated linearly between the two nearest angles, or, where frames are coarser than "
       "angles, averaged over the angles that it spans, so that a turn delivers the same light.",
       "Rows: z = 0 is at projector.axis_row, counted from the top, and z points upwards. Slices are interpolated "
       "linearly to rows, or averaged where they are finer than rows. Columns are those of vam-resample, which has put "
       "the axis at projector.axis_column; --column-offset moves them from there. Light that would fall outside the "
       "projector is an error. The orientation is applied last.",
       "Grey: a value of --peak (by default the largest of the stack) becomes full intensity, times --intensity. Each "
       "pixel gets the grey level whose intensity, by the measured response (projector.response) or else the straight "
       "line from min_intensity to max_intensity, is nearest to the wanted one.",
       "Slices of continuous stereolithography (vam-curethrough correct) are shown one after the other, each once, "
       "slice n from n / fps on, with fps = print speed / slice height: both stand in the EXR stack, --print-speed or "
       "--fps override them, and a folder of pictures has its times in frames.csv. The slices that the last feature "
       "needs at the end are part of the stack. A slice that is smaller than the projector's picture is put with its "
       "middle at axis_column, axis_row; its values are fractions of full intensity, or grey. Live they are held for 1 "
       "/ fps each, by elapsed time, and all are in memory beforehand.",
       "With --flatland the frames show one slice of a virtual sinogram from above: each is the 1-D projection at its "
       "angle, smeared across the plane. Projected onto a thin layer of resin they print the cross-section, and the "
       "sum of the frames is its dose (Kelly et al. 2017, fig 3)."},
      {{"A part's frames as numbered pictures:",
        "vam-slice --shape disc-grid --voxel 0.2 | vam-sinogram --filter ram-lak --negative clip | vam-resample -o "
        "projector.exr && vam-project projector.exr -o frames/"},
       {"The same as a lossless video of two turns at 24 deg/s and 30 frames per second:",
        "vam-project projector.exr --turns 2 --speed 24 --fps 30 -o print.mkv"},
       {"Black and white frames for a projector that hangs upside down:",
        "vam-project projector.exr --bits 1 --orientation rotate-180 -o black-white/"},
       {"The validation movie of the slice in the middle:",
        "vam-slice --shape disc-grid --voxel 0.2 | vam-sinogram --filter ram-lak --negative clip | vam-project "
        "--flatland 0 -o flatland.mp4"},
       {"The slices of a continuous print, 1000 mm/h at 50 um a slice, as a video of 5.56 frames per second:",
        "vam-slice --shape ladder:rungs=2 --voxel 0.05 --stretch-z 1 | vam-curethrough correct --max-intensity 110 "
        "--min-intensity 0.2 -o slices.exr && vam-project slices.exr --set projector.pixel_mm=0.05 -o slices.mkv"},
       {"A focus star as a picture:", "vam-project --pattern star -o star/"},
       {"A synchronised print of one turn, here on a simulated stage and no screen:",
        "vam-stage spin --speed 90 | vam-project projector.exr -o null: --follow - --speed 90 --missed 0.1"}},
      {"Safety (live output). When vam-project dies of anything, hangs for 0.5 s, loses the stage's angles for 0.3 s "
       "or misses too many flips, the screen is black and the light engine dark within 100 ms: a child process, the "
       "guardian, holds the order. This is software and no interlock: wire a hardware one that cuts the light. A "
       "window that goes shows the desktop behind it, so make that black and keep the pointer on another screen. The "
       "LED current is never raised above projector.max_led_current. When a print by drm: has ended, Linux may bring "
       "its "
       "text console back to the screen: keep the console elsewhere (kernel option fbcon=map:) and let --light, which "
       "then sleeps, or a shutter have the last word.",
       "Light engines. dlpc350:SERIAL (LightCrafter 4500) and dlpc900:SERIAL (6500, 9000) on USB take the options "
       "current=0..255, max_current (at most projector.max_led_current) and leds (any of r, g and b; b unless given). "
       "The engine is woken, set to video with its gamma off, and every setting is read back before light. In the end "
       "its LEDs are switched off, then patterns are stopped, then it is put to sleep.",
       "Linear grey: besides the engine's gamma the table of the graphics card must be straight. drm: makes it so and "
       "reads it back; sdl: takes that of the desktop (xrandr --gamma 1:1:1 straightens it).",
       "Memory: the lit columns of the whole stack as floats, at most 4 bytes x angles x slices x columns (360 angles "
       "x 200 slices x 400 lit columns: 115 MB), and a few frames. A sinogram cannot be turned into frames slice by "
       "slice.",
       "PNG: 1, 2, 4 and 8 bits are stored at that depth. 10 bits are stored in 16, spread over the full range and "
       "marked by an sBIT chunk, as the PNG specification asks; shifting right by 6 gives the level back. Video: "
       "depths below 8 bits are spread over 0..255, 10 bits are gray10le with the levels as they are, 16 bits "
       "gray16le. Matroska rounds time stamps to 1 ms; the frame rate itself is exact.",
       "stage.direction has done its work in vam-resample, whose rows are stage angles; the stage angle of frames only "
       "rises.",
       "Sources: Kelly et al., Computed Axial Lithography, 2017; Orth et al., Correcting ray distortion in tomographic "
       "additive manufacturing, Opt. Express 2021."},
      {"vam-optimize", "vam-resample", "vam-curethrough", "vam-stage", "vam-view"}};
}

void declare(cli::App& app, Options& options) {
  app.positional("SINOGRAM", options.input,
                 "Sinogram stack (EXR) for the projector, with --flatland a virtual one; or the slices of "
                 "vam-curethrough, a frame stack (EXR) or a folder of pictures.");
  cli::add_output(app, options.output);
  app.group("Time");
  app.option("--fps", "HZ", options.fps, cli::positive,
             "Frames per second; without it projector.fps, or for slices print speed / slice height.");
  app.option("--print-speed", "MM_H", options.print_speed_mm_h, cli::positive,
             "Speed of the platform, for slices; without it what the stack says.");
  app.option("--speed", "DEG/S", options.speed_deg_s, cli::positive, "Stage speed; without it stage.speed_deg_s.");
  app.option("--turns", "N", options.turns, cli::positive, "Turns, whole or not; without it stage.turns.");
  app.group("Place");
  app.choice("--orientation", options.orientation, {"normal", "flip-columns", "flip-rows", "rotate-180"},
             "How the projector is mounted; without it projector.orientation.");
  app.option("--column-offset", "PX", options.column_offset, {-65536, 65536},
             "Move the light to the right, by fractions too.");
  app.option("--row-offset", "PX", options.row_offset, {-65536, 65536}, "Move the light down, by fractions too.");
  app.option("--flatland", "MM", options.flatland_mm, cli::any, "Show the slice nearest to this z from above.");
  app.group("Grey");
  app.option("--bits", "N", options.bits, {1, 16}, "1, 2, 4, 8, 10 or 16 bits a pixel; without it projector.bits.");
  app.option("--peak", "VALUE", options.peak, cli::positive,
             "The value that becomes full intensity; without it the largest of the stack, for slices 1.");
  app.option("--intensity", "FACTOR", options.intensity, cli::positive,
             "Multiplies all light; beyond full it is clipped.");
  tool::add_live(app, options.live);
  tool::add_patterns(app, options.pattern);
  cli::add_printer(app, options.printer);
  app.group("Output and machine");
  cli::add_stack_output(app, options.stack.half, options.stack.compression);
  cli::add_report(app, options.report);
  cli::add_threads(app);
}

model::Printer settings(const Options& options) {
  model::Printer printer = tool::load_printer(options.printer);
  printer.projector.fps = options.fps.value_or(printer.projector.fps);
  printer.projector.bits = options.bits.value_or(printer.projector.bits);
  printer.stage.speed_deg_s = options.speed_deg_s.value_or(printer.stage.speed_deg_s);
  if (!options.orientation.empty()) printer.projector.orientation = options.orientation;
  const int bits = printer.projector.bits;
  if (bits != 1 && bits != 2 && bits != 4 && bits != 8 && bits != 10 && bits != 16) {
    throw Error{Fault::usage, "--bits: " + std::to_string(bits) + " is none of 1, 2, 4, 8, 10, 16"};
  }
  return printer;
}

// What to show around a stage angle, over a span of angles, in the units of the stack whose largest value is peak.
struct Light {
  std::function<Image(double angle_deg, double span_deg)> frame;
  double peak = 0;
};

template <class Source>
Light read_light(io::StackReader& reader, const std::shared_ptr<Source>& source) {
  Progress progress("reading", reader.info().count);
  Image slice;
  for (model::ImageInfo about; reader.next(slice, about); progress.tick()) source->add(slice, about.z_mm);
  source->check();
  return {[source](double angle, double span) { return source->frame(angle, span); },
          static_cast<double>(source->peak())};
}

Light read_light(const Options& options, io::StackReader& reader, const model::Projector& projector) {
  const auto& info = reader.info();
  const double right = options.column_offset;
  const double down = options.row_offset;
  if (options.flatland_mm) {
    io::require(options.input, info, model::Kind::sinogram, model::Space::virtual_);
    const auto canvas = optics::flatland_canvas(projector, right, down);
    return read_light(reader,
                      std::make_shared<optics::FlatlandSlice>(options.input, info, canvas, *options.flatland_mm));
  }
  io::require(options.input, info, model::Kind::sinogram, model::Space::projector);
  const auto place = optics::frame_place(projector, right, down);
  return read_light(reader, std::make_shared<optics::FrameComposer>(options.input, info, place));
}

project::Frames frames_of(const Light& light, const optics::FrameSchedule& schedule) {
  return {schedule.count, schedule.fps, schedule.step_deg,
          [&](int n) { return light.frame(schedule.angle_deg(n), schedule.step_deg); }, false};
}

bool is_folder(const std::string& path) {
  std::error_code ignored;
  return path != "-" && std::filesystem::is_directory(path, ignored);
}

// Slices know no stage: they are shown one after the other in time.
project::Frames slices_in_time(const cli::App& app, const Options& options, const model::Printer& printer,
                               const project::SliceStack& slices) {
  for (const char* option : {"--speed", "--turns", "--flatland", "--frames-per-turn", "--follow"}) {
    if (!app.given(option)) continue;
    throw Error{Fault::usage, std::string(option) + ": " + slices.name +
                                  " holds slices, which are shown once, by time; leave it out"};
  }
  const double fps = project::slices_per_s(slices, {options.fps, options.print_speed_mm_h});
  return project::frames_of(slices, fps, printer.projector, options.column_offset, options.row_offset);
}

Json slice_report(const project::Frames& frames, const Options& options, const model::Projector& projector,
                  const resin::LightTally& tally) {
  Json report = figures(frames, projector.bits, options.peak.value_or(1), tally);
  report.erase("step_deg");
  return report;
}

void play_slices(const cli::App& app, const Options& options, const model::Printer& printer,
                 const project::SliceStack& slices, tool::Live& live) {
  const project::Frames frames = slices_in_time(app, options, printer, slices);
  tool::LiveSequence sink(live, 1 / frames.fps);
  const auto scale = static_cast<float>(options.intensity / options.peak.value_or(1));
  const auto tally = project::show(frames, scale, printer.projector, app.given("--bits"), sink);
  project::warn_clipped(tally);
  Json report = slice_report(frames, options, printer.projector, tally);
  report["flips"] = sink.tally.flips;
  report["lit_flips"] = sink.tally.lit;
  report["missed_flips"] = sink.tally.missed;
  io::write_report(options.report, "vam-project/1", report);
}

void write_slices(const cli::App& app, const Options& options, const model::Printer& printer,
                  const project::SliceStack& slices) {
  const project::Frames frames = slices_in_time(app, options, printer, slices);
  io::FrameSinkOptions facts{project::facts_of(slices, frames.fps, printer.projector), frames.fps,
                             printer.projector.bits, options.stack};
  facts.info.history.push_back(app.history());
  const auto sink = io::open_frame_sink(options.output, facts);
  const auto scale = static_cast<float>(options.intensity / options.peak.value_or(1));
  const auto tally = project::show(frames, scale, printer.projector, app.given("--bits"), *sink);
  project::warn_clipped(tally);
  io::write_report(options.report, "vam-project/1", slice_report(frames, options, printer.projector, tally));
}

// One turn's frames into the display, then the print: the angle of the table chooses the frame.
void run_live(const cli::App& app, const Options& options, const model::Printer& printer) {
  const double turns = options.turns.value_or(printer.stage.turns);
  if (turns != std::floor(turns))
    throw Error{Fault::usage, "--turns: a live print has whole turns, not " + format_number(turns)};
  if (options.live.follow == "-" && options.input == "-") {
    throw Error{Fault::usage,
                "--follow -: standard input cannot be both the angles and the sinogram; name the sinogram"};
  }
  tool::Live live(options.live, options.output, {printer.projector.columns, printer.projector.rows, 60});
  if (is_folder(options.input)) return play_slices(app, options, printer, project::slice_folder(options.input), live);
  io::StackReader reader(options.input);
  if (reader.info().kind == model::Kind::frames) {
    return play_slices(app, options, printer, project::slices_of(options.input, reader), live);
  }
  const Light light = read_light(options, reader, printer.projector);
  const double peak = options.peak.value_or(light.peak);
  const int frames = options.live.frames_per_turn.value_or(reader.info().height);
  const auto schedule = optics::frame_schedule(frames, 360, 1);
  tool::LiveSink sink(live, printer.stage.speed_deg_s, static_cast<int>(turns));
  const project::Frames shown = frames_of(light, schedule);
  const auto tally =
      show(shown, static_cast<float>(options.intensity / peak), printer.projector, app.given("--bits"), sink);
  project::warn_clipped(tally);
  Json report = figures(shown, printer.projector.bits, peak, tally);
  report["duration_s"] = 360 * turns / printer.stage.speed_deg_s;
  report.erase("fps_hz");
  report["flips"] = sink.tally.flips;
  report["lit_flips"] = sink.tally.lit;
  report["missed_flips"] = sink.tally.missed;
  io::write_report(options.report, "vam-project/1", report);
}

void write_turns(const cli::App& app, const Options& options, const model::Printer& printer, io::StackReader& reader) {
  const model::Projector& projector = printer.projector;
  const double turns = options.turns.value_or(printer.stage.turns);
  const auto schedule = optics::frame_schedule(projector.fps, printer.stage.speed_deg_s, turns);
  const Light light = read_light(options, reader, projector);
  const double peak = options.peak.value_or(light.peak);

  const auto place = optics::frame_place(projector, options.column_offset, options.row_offset);
  io::FrameSinkOptions facts{optics::frames_info(reader.info(), place, schedule, projector.orientation), projector.fps,
                             projector.bits, options.stack};
  facts.info.units = "fraction of full intensity";
  facts.info.history.push_back(app.history());
  const auto sink = io::open_frame_sink(options.output, facts);
  const project::Frames frames = frames_of(light, schedule);
  const auto tally = show(frames, static_cast<float>(options.intensity / peak), projector, app.given("--bits"), *sink);
  project::warn_clipped(tally);
  io::write_report(options.report, "vam-project/1", figures(frames, projector.bits, peak, tally));
}

void run(const cli::App& app, Options& options) {
  const model::Printer printer = settings(options);
  const model::Projector& projector = printer.projector;
  if (tool::print_printer(options.printer, printer, options.output)) return;
  options.live.max_led_current = projector.max_led_current;
  if (!options.pattern.plan.name.empty()) {
    return tool::run_pattern(app, options.pattern, options.live, options.output, options.stack, projector);
  }
  if (!options.live.latency_ms) options.live.latency_ms = projector.latency_ms;
  if (device::names_display(options.output)) {
    return device::interruptible([&] { run_live(app, options, printer); });
  }
  if (io::frame_output(options.output) != io::FrameOutput::folder) io::refuse_same_file(options.input, options.output);
  if (is_folder(options.input)) return write_slices(app, options, printer, project::slice_folder(options.input));
  io::StackReader reader(options.input);
  if (reader.info().kind == model::Kind::frames) {
    return write_slices(app, options, printer, project::slices_of(options.input, reader));
  }
  write_turns(app, options, printer, reader);
}

}  // namespace

int main(int argc, char** argv) {
  cli::App app(manual());
  Options options;
  declare(app, options);
  return app.run(argc, argv, [&] { run(app, options); });
}
