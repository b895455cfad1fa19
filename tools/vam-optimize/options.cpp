#include "vam-optimize/options.hpp"

#include <cmath>
#include <utility>
#include <vector>

#include "base/error.hpp"
#include "base/text.hpp"
#include "io/settings/csv_table.hpp"
#include "optimize/methods/automatic.hpp"
#include "optimize/run/slice_figures.hpp"

namespace vam::optimize_tool {

void declare(cli::App& app, Options& options) {
  app.positional("TARGET", options.input, "Volume (VDB) with a grid 'target' of coverage 0...1.");
  cli::add_output(app, options.output);
  std::vector<std::string> methods{"auto"};
  methods.insert(methods.end(), optimize::method_names().begin(), optimize::method_names().end());
  app.choice("--method", options.method, methods,
             "How to look for projections; auto is apg, the best of tests/bench/printability, for 8 iterations at "
             "least and until the part prints with a process window of 0.05.");
  app.choice(
      "--geometry", options.geometry, {"vial", "parallel"},
      "Whose light: vial works with the projector's own rays, as lens, bath, glass and resin bend them, and makes "
      "a projector sinogram; parallel makes a virtual one, for vam-resample, in a third of the time.");
  app.option("--angles", "N", options.angles, {1, 100000}, "Stage angles over 360 degrees.");
  app.option("--columns", "N", options.columns, {1, 65536},
             "Columns, each a voxel wide; without it as many as see the writable circle.");
  app.group("What is asked");
  app.option("--dose-low", "DOSE", options.demands.window.low, cli::non_negative,
             "The void's dose should stay below this.");
  app.option("--dose-high", "DOSE", options.demands.window.high, cli::positive, "The part's dose should reach this.");
  app.option("--tolerance-mm", "MM", options.tolerance_mm, cli::non_negative,
             "Ask nothing of voxels within this distance of the part's surface.");
  app.flag("--surface", options.demands.surface, "Ask surface voxels too: part when at least half covered, else void.");
  app.option("--weights", "FILE", options.weights,
             "Volume (VDB) with a grid 'weight', or a single grid: what an error of each voxel costs, relative to "
             "others. 0: nothing is asked of it. Without it the target's file, if that has one.");
  app.flag("--grey", options.demands.grey,
           "The target is a dose (or response) for every voxel, to be met within --band.");
  app.option("--band", "EPSILON", options.demands.band, {0, 0.5},
             "bclp, --grey: how far the resin's response may be from the target.");
  app.option("--tolerances", "FILE", options.tolerances,
             "Volume (VDB) with a grid 'tolerance', or a single grid: the band of each voxel. Without it the target's "
             "file, if that has one.");
  app.option("--response", "CURVE", options.response,
             "cal, bclp, --grey: what the resin makes of a dose: linear (the dose itself; usual with --grey), step "
             "(from LOW to HIGH), logistic, or a CSV file with columns dose,response, which also gives LOW and HIGH.");
  app.option("--softness", "GAMMA", options.softness, cli::positive, "Width of the logistic response, in doses.");
  app.group("When to stop");
  app.option("--iterations", "N", options.iterations, {0, 1000000},
             "At most so many. Without it fbp 0, dose-norm 1, cal and osmo 30, pm, bclp and apg 60.");
  app.option("--until", "CONDITIONS", options.until,
             "Stop when all hold, e.g. 'ver=0,pw>=0.1'; figures: ver, pw, ipdr, cv, iou.");
  app.option("--patience", "N", options.limits.patience, {0, 1000000},
             "Stop when IoU + PW has not improved by 1e-4 in so many iterations; 0 = never.");
  app.option("--init", "SINOGRAM", options.init, "Start from these projections (EXR, of the same size).");
  app.option("--checkpoint", "FILE", options.checkpoint,
             "When interrupted (SIGINT, SIGTERM), keep the last complete iterate there. When FILE is there already, go "
             "on from it; the result is the same, bit for bit. Removed when done.");
  app.option("--trace", "FILE", options.trace, "Write the figures of merit after every iteration as CSV.");
  app.group("Methods");
  app.option("--background", "B", options.how.background, {0, 1}, "dose-norm: the void's target.");
  app.option("--floor", "LIGHT", options.how.floor, cli::any, "fbp, dose-norm: light is not let below this.");
  app.choice("--negative", options.negative, {"clip", "offset"},
             "fbp: set negative light to the floor, or raise all of a slice by its lowest.");
  app.option("--power", "P", options.how.power, {1, 20}, "pm, bclp: the norm's exponent.");
  app.option("--max-light", "LIGHT", options.how.peak, cli::non_negative, "Largest light; 0 = any.");
  app.group("Light and resin");
  app.choice("--absorption", options.absorption, {"exact", "disc", "none"},
             "What the absorption of the resin (resin.absorption_per_mm) does to the light: exact everywhere; first "
             "projections corrected by a uniform disc's dose; or left out.");
  app.flag("--no-blur", options.no_blur, "Do not make up for point spread and diffusion.");
  app.option("--seconds", "S", options.seconds, cli::non_negative,
             "Time for which dose diffuses. Without it the time of stage.turns turns.");
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
  options.method = optimize::automatic_method;
  if (!options.until.empty() || app.given("--iterations")) return;
  options.limits.at_least = optimize::automatic_iterations;
  options.until = options.demands.grey ? "ver=0" : optimize::automatic_until;
}

void refuse_contradictions(const Options& options, const optimize::Method& method) {
  optimize::check(options.demands);
  if (options.peak && !options.bits) throw Error{Fault::usage, "--peak: has no meaning without --bits"};
  if (options.error_feedback && !options.bits) {
    throw Error{Fault::usage, "--error-feedback: has no meaning without --bits"};
  }
  if (options.geometry == "vial" && options.columns) {
    throw Error{Fault::usage,
                "--columns: has no meaning with --geometry vial, the projector has its own; use --geometry parallel"};
  }
  if (options.geometry == "vial" && options.absorption == "disc") {
    throw Error{Fault::usage, "--absorption disc: is for parallel light; use --geometry parallel"};
  }
  if (options.demands.grey && !method.takes_grey()) {
    throw Error{Fault::usage, "--grey: " + options.method + " knows part and void only; use apg, pm or bclp"};
  }
  if (options.demands.grey && (options.tolerance_mm > 0 || options.demands.surface)) {
    throw Error{Fault::usage, "--grey: a target of doses has no surface; leave out --tolerance-mm and --surface"};
  }
}

}  // namespace

void settle(const cli::App& app, Options& options) {
  settle_auto(app, options);
  const auto method = optimize::make_method(options.method, options.how);
  refuse_contradictions(options, *method);
  if (options.demands.grey && !app.given("--response")) options.response = "linear";
  options.how.offset = options.negative == "offset";
  options.limits.iterations = options.iterations.value_or(method->usual_iterations());
  if (!options.until.empty()) {
    options.limits.until = model::parse_conditions(options.until, optimize::SliceFigures::names());
  }
}

namespace {

optimize::CureCurve read_curve(const std::string& path) {
  const io::CsvTable table = io::read_csv(path, {"dose", "response"});
  std::vector<std::pair<double, double>> points;
  for (std::size_t row = 0; row < table.rows.size(); ++row) {
    points.emplace_back(table.number(row, 0), table.number(row, 1));
  }
  try {
    return optimize::CureCurve::table(points);
  } catch (const Error& error) {
    throw Error{error.fault, path + ": " + error.what()};
  }
}

/// LOW and HIGH are the doses whose response is a band from liquid and from cured.
void settle_window(const cli::App& app, const std::string& path, optimize::Demands& demands) {
  const auto band = static_cast<float>(demands.band);
  const double low = static_cast<double>(demands.curve.doses(0, band).high);
  const double high = static_cast<double>(demands.curve.doses(1, band).low);
  if (!std::isfinite(low) || !std::isfinite(high)) {
    throw Error{Fault::data, path + ": the response must reach from " + format_number(demands.band) + " to " +
                                 format_number(1 - demands.band) + " (--band); measure more doses or name --band"};
  }
  if (!app.given("--dose-low")) demands.window.low = low;
  if (!app.given("--dose-high")) demands.window.high = high;
  optimize::check(demands);
}

}  // namespace

void settle_response(const cli::App& app, Options& options) {
  optimize::Demands& demands = options.demands;
  const optimize::Window& window = demands.window;
  if (options.response == "linear") {
    demands.curve = optimize::CureCurve::linear();
  } else if (options.response == "step") {
    demands.curve = optimize::CureCurve::step(window.low, window.high);
  } else if (options.response == "logistic") {
    demands.curve = optimize::CureCurve::logistic(window.threshold(), options.softness);
  } else {
    demands.curve = read_curve(options.response);
    if (!demands.grey) settle_window(app, options.response, demands);
  }
}

std::string job(const Options& options, const std::string& printer) {
  std::string text = printer;
  const auto add = [&](const std::string& part) { text += part + "\n"; };
  const auto number = [&](double value) { add(format_number(value, 17)); };
  for (const auto* word :
       {&options.method, &options.geometry, &options.response, &options.negative, &options.absorption})
    add(*word);
  const optimize::Demands& asked = options.demands;
  const optimize::MethodOptions& how = options.how;
  for (const double value : {asked.window.low, asked.window.high, asked.band, options.softness, options.tolerance_mm,
                             how.background, how.floor, how.peak, how.power, options.seconds.value_or(-1)}) {
    number(value);
  }
  for (const bool flag : {asked.surface, asked.grey, options.no_blur, !options.init.empty()}) add(flag ? "1" : "0");
  number(options.angles);
  number(options.columns.value_or(0));
  return text;
}

}  // namespace vam::optimize_tool
