#include "vam-optimize/options.hpp"

#include <vector>

#include "base/error.hpp"
#include "optimize/slice_figures.hpp"

namespace vam::optimize_tool {

void declare(cli::App& app, Options& options) {
  app.positional("TARGET", options.input, "Volume (VDB) with a grid 'target' of coverage 0...1.");
  cli::add_output(app, options.output);
  std::vector<std::string> methods{"auto"};
  methods.insert(methods.end(), optimize::method_names().begin(), optimize::method_names().end());
  app.choice(
      "--method", options.method, methods,
      "How to look for projections; auto is apg, the best of tests/bench/printability, until the part prints with "
      "a process window of 0.05.");
  app.choice("--geometry", options.geometry, {"parallel", "vial"},
             "Whose light: parallel makes a virtual sinogram, for vam-resample; vial works with the projector's own "
             "rays, as lens, bath, glass and resin bend them, and makes a projector sinogram.");
  app.option("--angles", "N", options.angles, {1, 100000}, "Stage angles over 360 degrees.");
  app.option("--columns", "N", options.columns, {1, 65536},
             "Columns, each a voxel wide; without it as many as see the writable circle.");
  app.group("When to stop");
  app.option("--iterations", "N", options.iterations, {0, 1000000},
             "At most so many. Without it fbp 0, dose-norm 1, cal and osmo 30, pm, bclp and apg 60.");
  app.option("--until", "CONDITIONS", options.until,
             "Stop when all hold, e.g. 'ver=0,pw>=0.1'; figures: ver, pw, ipdr, cv, iou.");
  app.option("--patience", "N", options.limits.patience, {0, 1000000},
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

namespace {

/// auto is the method that measures best, stopped where the part prints with room to spare unless the user says when.
void settle_auto(const cli::App& app, Options& options) {
  if (options.method != "auto") return;
  options.method = "apg";
  if (options.until.empty() && !app.given("--iterations")) options.until = "ver=0,pw>=0.05";
}

}  // namespace

void settle(const cli::App& app, Options& options) {
  settle_auto(app, options);
  if (options.peak && !options.bits) throw Error{Fault::usage, "--peak: has no meaning without --bits"};
  if (options.geometry == "vial" && options.columns) {
    throw Error{Fault::usage, "--columns: has no meaning with --geometry vial, the projector has its own"};
  }
  if (options.geometry == "vial" && options.absorption == "disc") {
    throw Error{Fault::usage, "--absorption disc: is for parallel light; --geometry vial knows the exact absorption"};
  }
  if (options.error_feedback && !options.bits) {
    throw Error{Fault::usage, "--error-feedback: has no meaning without --bits"};
  }
  options.how.offset = options.negative == "offset";
  options.how.thresholding = !options.no_threshold;
  const auto method = optimize::make_method(options.method, options.how);  // contradictions are found before files
  options.limits.iterations = options.iterations.value_or(method->usual_iterations());
  if (!options.until.empty()) {
    options.limits.until = model::parse_conditions(options.until, optimize::SliceFigures::names());
  }
}

}  // namespace vam::optimize_tool
