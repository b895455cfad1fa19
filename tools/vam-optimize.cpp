// vam-optimize: projections that print a target.
#include <algorithm>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "base/log.hpp"
#include "cli/app.hpp"
#include "cli/common.hpp"
#include "io/exr_stack.hpp"
#include "io/printer_file.hpp"
#include "io/report.hpp"
#include "io/response_file.hpp"
#include "io/stream.hpp"
#include "io/vdb.hpp"
#include "optimize/attenuated_operator.hpp"
#include "optimize/parallel_operator.hpp"
#include "optimize/quantise.hpp"
#include "optimize/shadowed_operator.hpp"
#include "optimize/slice_figures.hpp"
#include "optimize/volume.hpp"
#include "tomo/fbp.hpp"

namespace {

using namespace vam;

struct Options {
  std::string input = "-";
  std::string output = "-";
  std::string method = "auto";
  int angles = 360;
  std::optional<int> columns;
  std::optional<int> iterations;
  int patience = optimize::Limits{}.patience;
  std::string until;
  std::string init;
  std::string trace;
  std::string report;
  std::string negative = "clip";
  std::string absorption = "exact";
  bool no_threshold = false;
  optimize::MethodOptions how;
  std::optional<int> bits;
  std::optional<double> peak;
  bool error_feedback = false;
  cli::PrinterOptions printer;
  io::StackOptions stack;
};

cli::Manual manual() {
  return {
      "vam-optimize",
      "find projections that print a part",
      {"Light only adds up, so no set of projections gives exactly the dose that a part asks for. vam-optimize reads "
       "the "
       "target (VDB, coverage 0...1) and looks for non-negative projections whose dose separates part from void, so "
       "that a resin with a threshold prints the part. It writes a virtual (parallel-beam) sinogram stack, one image a "
       "slice; vam-resample takes it to a real projector.",
       "Methods: fbp is filtered back-projection with negative light set to 0. dose-norm raises the void to a "
       "background and divides the target once by the dose that it gets: quick and good. cal descends the gradient of "
       "the print's error with the resin's threshold inside the loop. osmo corrects a model of the part by the dose's "
       "errors, void and part in turn. pm minimises how far doses are on the wrong side of LOW and HIGH, to the power "
       "P; bclp how far the resin's response is outside a band around the target. apg, the best of them, asks the void "
       "to stay "
       "below LOW and the part to reach HIGH and descends by preconditioned, accelerated projected gradient; it has no "
       "step to choose, and a slice that has reached both is asked for a wider window.",
       "The dose that the projections give is relative: the printing threshold is (LOW + HIGH)/2 of --dose-low and "
       "--dose-high, the same number in every slice. Each slice is scaled so that this threshold lies in the middle of "
       "its process window, or so that the part's least dose is HIGH where the window is wider than that. Adding up "
       "light * (angle step in radian) over all angles along the rays gives this dose.",
       "A grid 'insert' in the same file is an opaque object to print around (overprinting): rays carry no light "
       "behind "
       "it. Part voxels that no light can reach are counted in the report and left out.",
       "A resin that absorbs (resin.absorption_per_mm) weakens light on its way: e^(-mu s) is then part of the dose "
       "that the method works with, s the path from where the ray enters the resin, and light is what enters there.",
       "Voxels that the part's surface cuts (0 < coverage < 1) are neither part nor void: they are asked for nothing. "
       "A slice that has only such voxels is printed if any of them is at least half covered."},
      {{"Projections of a gyroid for the default printer:",
        "vam-slice --shape gyroid --voxel 0.25 -o part.vdb && vam-optimize part.vdb -o light.exr"},
       {"Computed axial lithography, with the figures of merit of every iteration:",
        "vam-optimize --method cal --iterations 20 --trace trace.csv part.vdb -o cal.exr"},
       {"Go on from there until the part separates from the void:",
        "vam-optimize --method cal --init cal.exr --until 'ver=0,pw>=0.02' --iterations 40 part.vdb -o better.exr"},
       {"In the 16 grey levels of a 4-bit projector:",
        "vam-optimize --bits 4 --error-feedback part.vdb -o coarse.exr"}},
      {"Figures of merit (physics of the field: VER, PW, IPDR, CV, IoU; vam-score has their definitions) are worked "
       "out "
       "slice by slice. In --trace and --until PW is that of the worst slice, IPDR the largest, the others are means "
       "by voxel count.",
       "Speed: identical slices are computed once. Parallel light gives the same dose from either side, so for an even "
       "number of angles half of them are computed and mirrored. Memory: 64 slices at a time, six arrays of a slice or "
       "sinogram each, plus at most 512 MiB of finished slices that come again; with --bits and without --peak all "
       "projections.",
       "Sources: Kelly et al., Computed Axial Lithography, 2017, eq 3 and fig 2; Kelly et al., Science 2019, eq 4; "
       "Orth "
       "et al., On-the-fly 3D metrology of volumetric additive manufacturing, 2022, Methods and fig S6 (where the text "
       "floors the projections at the background, but the figures show them non-negative: --floor 0 is right); Rackson "
       "et al., Object-space optimization of tomographic reconstructions, 2021 (osmo); Bhattacharya et al., High "
       "fidelity volumetric additive manufacturing, 2021 (pm); Li et al., band-constraint Lp-norm, 2024 (bclp); Beck "
       "and Teboulle, FISTA, 2009, and Bertsekas, two-metric projection, 1982 (apg)."},
      {"vam-slice", "vam-sinogram", "vam-resample", "vam-dose", "vam-score"}};
}

void declare(cli::App& app, Options& options) {
  app.positional("TARGET", options.input, "Volume (VDB) with a grid 'target' of coverage 0...1.");
  cli::add_output(app, options.output);
  std::vector<std::string> methods{"auto"};
  methods.insert(methods.end(), optimize::method_names().begin(), optimize::method_names().end());
  app.choice(
      "--method", options.method, methods,
      "How to look for projections; auto is apg, the best of tests/bench/printability, until the part prints with "
      "a process window of 0.05.");
  app.option("--angles", "N", options.angles, {1, 100000}, "Stage angles over 360 degrees.");
  app.option("--columns", "N", options.columns, {1, 65536},
             "Columns, each a voxel wide; without it as many as see the writable circle.");
  app.group("When to stop");
  app.option("--iterations", "N", options.iterations, {0, 1000000},
             "At most so many. Without it fbp 0, dose-norm 1, cal and osmo 30, pm, bclp and apg 60.");
  app.option("--until", "CONDITIONS", options.until,
             "Stop when all hold, e.g. 'ver=0,pw>=0.1'; figures: ver, pw, ipdr, cv, iou.");
  app.option("--patience", "N", options.patience, {0, 1000000},
             "Stop when IoU + PW has not improved by 1e-4 in so many iterations; 0 = never.");
  app.option("--init", "SINOGRAM", options.init, "Start from these projections (EXR, of the same size).");
  app.option("--trace", "FILE", options.trace, "Write the figures of merit after every iteration as CSV.");
  app.group("Methods");
  app.option("--dose-low", "DOSE", options.how.window.low, cli::non_negative,
             "The void's dose should stay below this.");
  app.option("--dose-high", "DOSE", options.how.window.high, cli::positive, "The part's dose should reach this.");
  app.option("--background", "B", options.how.background, {0, 1}, "dose-norm: the void's target.");
  app.option("--floor", "LIGHT", options.how.floor, cli::any, "fbp, dose-norm: light is not let below this.");
  app.choice("--negative", options.negative, {"clip", "offset"},
             "fbp: set negative light to the floor, or raise all of a slice by its lowest.");
  app.option("--softness", "GAMMA", options.how.softness, cli::positive,
             "cal, bclp: width of the resin's threshold, in doses.");
  app.option("--power", "P", options.how.power, {1, 20}, "pm, bclp: the norm's exponent.");
  app.option("--band", "EPSILON", options.how.band, {0, 0.5},
             "bclp: how far the resin's response (0...1) may be from the target.");
  app.option("--max-light", "LIGHT", options.how.peak, cli::non_negative, "apg, pm, bclp: largest light; 0 = any.");
  app.option("--step", "LAMBDA", options.how.step, cli::positive, "cal: length of a step.");
  app.flag("--no-threshold", options.no_threshold, "cal: a resin without threshold (for comparison).");
  app.choice("--absorption", options.absorption, {"exact", "disc", "none"},
             "What the absorption of the resin (resin.absorption_per_mm) does to the light: exact everywhere; first "
             "projections corrected by a uniform disc's dose; or left out.");
  app.group("Projector's grey levels");
  app.option("--bits", "N", options.bits, {1, 16},
             "Round the light to the intensities of this many bits, through projector.response.");
  app.option("--peak", "LIGHT", options.peak, cli::positive, "Light of full grey. Without it the largest of all.");
  app.flag("--error-feedback", options.error_feedback, "Add what rounding left over to the next angle.");
  cli::add_printer(app, options.printer);
  app.group("Output and machine");
  cli::add_report(app, options.report);
  cli::add_stack_output(app, options.stack.half, options.stack.compression);
  cli::add_threads(app);
}

/// Reads a stack slice after slice; a slice that is asked for again or out of order is an error of ours.
class Initial {
 public:
  Initial(const std::string& path, const model::StackInfo& want) : path_(path), reader_(path) {
    const auto& is = reader_.info();
    io::require(path, is, model::Kind::sinogram, model::Space::virtual_);
    if (is.width != want.width || is.height != want.height || is.count != want.count) {
      const auto size = [](const model::StackInfo& s) {
        return std::to_string(s.width) + " columns x " + std::to_string(s.height) + " angles x " +
               std::to_string(s.count) + " slices";
      };
      throw Error{Fault::data, path + ": " + size(is) + ", but the target needs " + size(want) +
                                   "; use the same target, --angles and --columns"};
    }
  }
  Image operator()(int k) {
    Image image;
    model::ImageInfo about;
    while (next_ <= k) {
      if (!reader_.next(image, about)) throw Error{Fault::data, path_ + ": ends at slice " + std::to_string(next_)};
      ++next_;
    }
    return image;
  }

 private:
  std::string path_;
  io::StackReader reader_;
  int next_ = 0;
};

model::StackInfo make_info(const io::SparseVolume& target, const tomo::ParallelGeometry& turn, const Options& options,
                           const std::string& history) {
  model::StackInfo info;
  info.width = turn.columns;
  info.height = turn.angles;
  info.count = target.grid().nz;
  info.pixel_mm = info.row_mm = target.grid().voxel_mm;
  info.z_start_mm = target.grid().z_mm(0);
  info.angle_step_deg = 360.0 / turn.angles;
  info.units = "1/rad";
  info.history = target.history;
  info.history.push_back(history);
  info.extra = target.metadata;
  info.extra["vam:threshold_dose"] = format_number(options.how.window.threshold());
  return info;
}

resin::GreyLevels grey_levels(const model::Printer& printer, int bits) {
  const auto& file = printer.projector.response;
  return {file.empty() ? resin::projector_response(printer.projector) : resin::Response(io::read_response(file)), bits};
}

struct Inputs {
  std::vector<io::SparseVolume> volumes;
  std::size_t target = 0;
  std::optional<std::size_t> insert;
};

Inputs read(const std::string& path) {
  Inputs in{io::read_volumes(path), 0, std::nullopt};
  const auto find = [&](const std::string& name) -> std::optional<std::size_t> {
    for (std::size_t i = 0; i < in.volumes.size(); ++i) {
      if (in.volumes[i].name() == name) return i;
    }
    return std::nullopt;
  };
  const auto target = find("target");
  if (!target) throw Error{Fault::data, path + ": has no grid 'target'; vam-slice makes one"};
  in.target = *target;
  in.insert = find("insert");
  if (in.insert && !(in.volumes[*in.insert].grid() == in.volumes[in.target].grid())) {
    throw Error{Fault::data,
                path + ": the insert's grid is not the target's; slice both together (vam-slice --insert)"};
  }
  return in;
}

/// Parallel light; the resin's absorption is in it unless it is to be left out.
std::unique_ptr<optimize::Operator> make_light(const tomo::ParallelGeometry& turn, const model::Grid& grid,
                                               const model::Printer& printer, const Options& options) {
  const double mu_per_px = printer.resin.absorption_per_mm * grid.voxel_mm;
  if (mu_per_px == 0 || options.absorption == "none") return std::make_unique<optimize::ParallelOperator>(turn);
  const double radius_px = model::resin_radius_mm(printer.vial) / grid.voxel_mm;
  const auto correction = options.absorption == "disc" ? optimize::Correction::disc : optimize::Correction::exact;
  return std::make_unique<optimize::AttenuatedOperator>(turn, mu_per_px, radius_px, correction);
}

/// auto is the method that measures best, stopped where the part prints with room to spare unless the user says when.
void settle_auto(const cli::App& app, Options& options) {
  if (options.method != "auto") return;
  options.method = "apg";
  if (options.until.empty() && !app.given("--iterations")) options.until = "ver=0,pw>=0.05";
}

void run(const cli::App& app, Options& options) {
  settle_auto(app, options);
  if (options.peak && !options.bits) throw Error{Fault::usage, "--peak: has no meaning without --bits"};
  if (options.error_feedback && !options.bits)
    throw Error{Fault::usage, "--error-feedback: has no meaning without --bits"};
  options.how.offset = options.negative == "offset";
  options.how.thresholding = !options.no_threshold;
  optimize::VolumeTask task;
  task.window = options.how.window;
  task.limits.patience = options.patience;
  task.limits.iterations =
      options.iterations.value_or(optimize::make_method(options.method, options.how)->usual_iterations());
  if (!options.until.empty()) {
    task.limits.until = model::parse_conditions(options.until, optimize::SliceFigures::names());
  }
  const model::Printer printer = io::load_printer(options.printer.file, options.printer.sets);
  if (options.printer.print) {
    io::OutputFile out(options.output, io::Content::text);
    out.write(io::printer_toml(printer));
    return out.commit();
  }
  io::refuse_same_file(options.input, options.output);
  if (!options.init.empty()) io::refuse_same_file(options.init, options.output);
  const Inputs in = read(options.input);
  const io::SparseVolume& target = in.volumes[in.target];
  const model::Grid& grid = target.grid();
  task.slices = grid.nz;
  task.circle = model::writable_circle(grid, printer);
  const auto turn =
      tomo::full_turn(grid, options.angles, options.columns.value_or(optimize::columns_for(task.circle, grid.nx)));
  task.circle.radius = std::min(task.circle.radius, 0.5 * turn.columns);
  const model::StackInfo info = make_info(target, turn, options, app.history());
  std::optional<Initial> initial;
  if (!options.init.empty()) {
    initial.emplace(options.init, info);
    task.initial = [&](int k) { return (*initial)(k); };
  }
  io::StackWriter out(options.output, info, options.stack);
  std::optional<optimize::Quantiser> levels;
  if (options.bits) {
    levels.emplace(grey_levels(printer, *options.bits), options.peak, options.error_feedback,
                   [&](const Image& image) { out.write(image); });
  }
  Progress progress("optimising", grid.nz);
  task.watch = !options.trace.empty();
  task.read = [&](int k, int count, float* to) { target.read_slices(k, count, to); };
  task.make = [&] { return optimize::make_method(options.method, options.how); };
  task.write = [&](int, const Image& image) {
    if (levels) {
      levels->add(image);
    } else {
      out.write(image);
    }
    progress.tick();
  };
  if (in.insert) {
    const io::SparseVolume& insert = in.volumes[*in.insert];
    task.read_insert = [&](int k, int count, float* to) { insert.read_slices(k, count, to); };
    task.around = [&](std::span<const optimize::Slab> inserts) -> std::unique_ptr<optimize::Operator> {
      const double mu_per_px = options.absorption == "none" ? 0 : printer.resin.absorption_per_mm * grid.voxel_mm;
      const double radius_px = model::resin_radius_mm(printer.vial) / grid.voxel_mm;
      return std::make_unique<optimize::ShadowedOperator>(turn, mu_per_px, radius_px, inserts);
    };
  }
  const auto light = make_light(turn, grid, printer, options);
  const auto outcome = optimize::optimise(task, *light);
  if (levels) levels->finish();
  if (outcome.dark_part_voxels > 0) {
    warn(options.input + ": no light reaches " + std::to_string(outcome.dark_part_voxels) +
         " voxels of the part behind the insert; they will not print");
  }
  if (!options.trace.empty()) {
    io::OutputFile trace(options.trace, io::Content::text);
    trace.write(optimize::trace_csv(outcome.trace));
    trace.commit();
  }
  Json report = optimize::report(outcome);
  report["method"] = options.method;
  report["threshold_dose"] = options.how.window.threshold();
  io::write_report(options.report, "vam-optimize/1", report);
  out.commit();
}

}  // namespace

int main(int argc, char** argv) {
  cli::App app(manual());
  Options options;
  declare(app, options);
  return app.run(argc, argv, [&] { run(app, options); });
}
