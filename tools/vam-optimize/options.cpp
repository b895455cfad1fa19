// SPDX-License-Identifier: GPL-3.0-or-later
#include "vam-optimize/options.hpp"

#include <cmath>
#include <functional>
#include <map>
#include <vector>

#include "base/text/text.hpp"
#include "optimize/methods/automatic.hpp"
#include "optimize/run/slice_figures.hpp"

namespace vam::optimize_tool {

namespace {

using Conditions = std::vector<std::string>;

/// "--method fbp", ...; auto is the method for which it stands.
Conditions methods_that(const std::function<bool(const optimize::MethodEntry&)>& may) {
  Conditions methods;
  if (may(optimize::method_entry(optimize::automatic_method))) methods.emplace_back("--method auto");
  for (const std::string& name : optimize::method_names(may)) methods.push_back("--method " + name);
  return methods;
}

Conditions readers(const std::string& flag) {
  return methods_that([&](const optimize::MethodEntry& entry) { return optimize::reads(entry, flag); });
}

Conditions grey_or_readers(const std::string& flag) {
  Conditions conditions = readers(flag);
  conditions.emplace_back("--grey-target");
  return conditions;
}

/// Those that compute their light at once.
Conditions at_once() {
  return methods_that([](const optimize::MethodEntry& entry) { return entry.iterations == 0; });
}

const Conditions in_vial{"--geometry vial"};
const Conditions parallel{"--geometry parallel"};

/// "0 (fbp), 1 (dose-norm), 30 (cal, osmo)"
std::string default_iterations() {
  std::map<int, std::vector<std::string>> names;
  for (const auto& entry : optimize::method_table()) names[entry.iterations].push_back(entry.name);
  std::vector<std::string> texts;
  for (const auto& [count, methods] : names) texts.push_back(std::to_string(count) + " (" + join(methods, ", ") + ")");
  return join(texts, ", ");
}

void declare_poses(cli::App& app, Options& options) {
  app.group("Poses of vial and part", in_vial);
  app.option("--poses", "FILE", options.poses,
             "Pose of the vial or the part in every frame: a table (CSV) with the columns "
             "angle_deg,dx_mm,dy_mm,dz_mm,moves, one line per frame, 360 / --angles degrees apart, for any number of "
             "turns. The table is stored in the stack.")
      .reads();
  app.option("--helix", "MM", options.helix_mm, cli::not_zero,
             "For parts taller than the image: lift of the vial per turn (negative: downwards), over the number of "
             "turns in which the whole part passes the image.")
      .excludes({"--poses"});
  app.option("--wobble-record", "RECORD", options.wobble_record,
             "Record of vam-calibrate edges or axis with the wobble of the vial, whose axis circles the rotation axis; "
             "the projections follow it.")
      .reads()
      .excludes({"--poses", "--helix"});
}

void declare_constraints(cli::App& app, Options& options) {
  app.group("Target constraints");
  app.option("--dose-low", "DOSE", options.demands.window.low, cli::non_negative,
             "LOW: upper bound on the dose of void voxels.")
      .not_for({grey_void});
  app.option("--dose-high", "DOSE", options.demands.window.high, cli::positive,
             "HIGH: lower bound on the dose of part voxels.")
      .not_for({grey_part});
  app.option("--weights", "FILE", options.weights,
             "Volume (VDB) with a grid 'weight', or with a single grid: relative cost of an error in each voxel. 0 "
             "leaves the voxel unconstrained.")
      .reads()
      .excludes(at_once());
  app.default_is("the grid 'weight' of the target file, if present");
  app.flag("--grey-target", options.demands.grey,
           "The target specifies a dose (or response) for every voxel, to be met within --band.")
      .only_with(methods_that([](const optimize::MethodEntry& entry) { return entry.grey; }));
  app.choice("--void", options.void_rule, {"met", "below", "free"},
             "Void, where the target is 0: must be 0 within --band (met) or not exceed --dose-low "
             "(below), or is unconstrained (free).")
      .only_with({"--grey-target"});
  app.option("--band", "EPSILON", options.demands.band, {0, 0.5},
             "Maximum deviation of the resin's response from the target.")
      .only_with(grey_or_readers("--band"));
  app.option("--band-volume", "FILE", options.band_volume,
             "Volume (VDB) with a grid 'tolerance', or with a single grid: --band for each voxel.")
      .reads()
      .only_with(grey_or_readers("--band"));
  app.default_is("the grid 'tolerance' of the target file, if present");
  app.option("--resin-response", "CURVE", options.response,
             "Response of the resin to the dose: linear (the dose itself), step (from LOW to HIGH), logistic, or a "
             "CSV file with columns dose,response, which also sets LOW and HIGH.")
      .only_with(grey_or_readers("--resin-response"));
  app.default_is("logistic; linear with --grey-target");
}

void declare_stopping(cli::App& app, Options& options) {
  app.group("Stopping criteria");
  app.option("--iterations", "N", options.iterations, {0, 1000000},
             "Number of iterations, which --until, --patience and --budget end before where they are given.")
      .excludes(at_once());
  app.default_is("at most " + default_iterations()).not_in_job().brief("Number of iterations.");
  app.option(
      "--until", "CONDITIONS", options.until,
      "Stop when all conditions hold, e.g. 'ver=0,pw>=0.1', and the print is the part: its pieces, walls, gaps and "
      "holes, also with 2 % less and more dose. Figures of merit: " +
          join(optimize::SliceFigures::names(), ", ") + ".");
  app.default_is(std::string(optimize::shortest_until) +
                 " with --shortest; with --method auto without --iterations the knee (--method); else no condition")
      .excludes(at_once())
      .not_in_job()
      .brief("Stop when all conditions hold, e.g. 'ver=0,pw>=0.1', and the print is the part.");
  app.option(
      "--patience", "N", options.limits.patience, {0, 1000000},
      "Stop when the figure of merit has not improved by 1e-4 in this number of iterations. The figure is IoU + "
      "latitude; where apg constrains the surface, its RMS distance in voxels beyond 0.1 is subtracted. The result is "
      "the best iteration, of those that meet --until if any does. 0 disables both: the result is the last, as with "
      "--robust.");
  app.default_is("10; --iterations where that is given").excludes(at_once()).not_in_job();
  app.option("--init", "SINOGRAM", options.init, "Initial projections (EXR, of the same size).").reads();
  app.option("--delivered", "DOSE", options.delivered,
             "Dose (VDB, in mJ/cm3) that the resin has received already, as of vam-dose --shown: the projections "
             "complete it to the target's, the threshold being resin.critical_dose_mj_cm3. --init are the "
             "projections for the whole dose, of which the optimisation starts with the share that is left; "
             "figures of merit and report are those of both doses together. Several doses add up.")
      .reads()
      .only_with({"--init"})
      .only_with({"resin.critical_dose_mj_cm3"})
      .only_with(in_vial)
      .only_with(readers("--delivered"))
      .excludes({"--grey-target", "--robust", "--shortest", "--tradeoff", "--certify", "--poses", "--helix",
                 "--wobble-record"});
  app.option("--budget", "SECONDS", options.budget_s, cli::positive,
             "Time for the computation as a whole: no iteration begins that would not leave enough of it for the rest. "
             "The result depends on the speed of the machine.")
      .excludes({"--checkpoint", "--tradeoff"})
      .excludes(at_once())
      .not_in_job();
  app.option("--checkpoint", "FILE", options.checkpoint,
             "File for the state of a run that is interrupted (SIGINT, SIGTERM). If FILE exists, the run resumes from "
             "it with bit-identical results; target, printer and all options that affect the result must be the same. "
             "Removed on completion.");
  app.brief("Keep an interrupted run here, and resume from it.");
  app.not_in_job().writes();
  app.option("--trace", "FILE", options.trace,
             "Write the figures of merit after every iteration as CSV; the result may be that of an earlier one than "
             "the last (--patience).")
      .writes_as({".csv"});
  app.not_in_job();  // whether there is one is part of the state
}

void declare_parameters(cli::App& app, Options& options) {
  app.group("Method parameters");
  app.option("--max-intensity", "VALUE", options.max_intensity, cli::non_negative,
             "Upper bound on projected intensity; 0 is none.")
      .only_with(readers("--max-intensity"));
  app.default_is(format_number(optimize::usual_of_even) +
                 " times the even intensity, at which the mean dose is the threshold dose if every pixel is lit at "
                 "every angle; raised by half while the conditions of --until are not met, without these while the "
                 "latitude is below " +
                 format_number(optimize::usual_raising.enough));
}

/// How long the print takes, which the brightest pixel determines.
void declare_duration(cli::App& app, Options& options) {
  app.option(
         "--turns", "N", options.turns, cli::positive,
         "Turns in which the print must be complete, with the brightest pixel at full grey: determines "
         "--max-intensity from resin.critical_dose_mj_cm3, resin.absorption_per_mm and "
         "projector.max_intensity_mw_cm2, and optimize.diffusion_time_s. (vam-project --turns sets the number of turns "
         "shown.)")
      .only_with(readers("--max-intensity"))
      .only_with({"resin.critical_dose_mj_cm3"})
      .only_with({"resin.absorption_per_mm"})
      .excludes({"--max-intensity"})
      .not_for({"poses that do not return"});
  app.brief("Turns in which the print must be complete.");
  app.flag("--shortest", options.shortest,
           "Find the shortest print that meets the conditions of --until: the maximum intensity begins at " +
               format_number(optimize::shortest_of_even) + " times the even intensity and is raised by " +
               format_number(100 * (optimize::shortest_raising.factor - 1)) + " % after every " +
               std::to_string(optimize::shortest_raising.next) +
               " iterations without success, which takes several times as long as a run.");
  app.only_with(readers("--max-intensity")).excludes({"--max-intensity", "--turns", "--grey-target"});
  app.brief("Find the shortest print that meets --until.");
  app.option("--tradeoff", "FILE", options.tradeoff,
             "Write the Pareto front of print duration and latitude, as CSV or as a figure (.png, .pdf or "
             ".svg), for "
             "at least " +
                 std::to_string(optimize::front_points) + " maximum intensities, from " +
                 format_number(optimize::shortest_of_even) + " times the even intensity upwards in steps of " +
                 format_number(100 * (optimize::front_raising.factor - 1)) + " %. Takes " +
                 std::to_string(optimize::front_iterations) +
                 " iterations; the projections written are those of the last maximum intensity.")
      .writes({".csv", ".png", ".pdf", ".svg"})
      .only_with(readers("--max-intensity"))
      .excludes({"--max-intensity", "--turns", "--shortest", "--until", "--iterations", "--patience", "--grey-target"});
}

void declare_proof(cli::App& app, Options& options) {
  app.group("Optimality bound");
  app.option("--certify", "FILE", options.certify,
             "After the optimisation, compute a lower bound on the ratio of the largest void dose to the least part "
             "dose that holds for any projections (certificate in the report), and write the weights that prove it as "
             "a volume (VDB); they are large in the regions that limit the process window. Takes up to " +
                 std::to_string(optimize::certify_iterations) +
                 " additional iterations, of a single slice in parallel light twice as many, until the bound is within "
                 "3 % of the least ratio reached.")
      .writes({".vdb"})
      .excludes({"--grey-target"});
}

void declare_tolerances(cli::App& app, Options& options) {
  std::vector<std::string> all;
  for (std::size_t i = 0; i < model::robust_kinds; ++i) {
    const model::Tolerance& one = model::tolerance_table[i];
    all.push_back(std::string(one.name) + " (" + std::string(one.meaning) + ")");
  }
  app.group("Tolerances of the printer");
  app.option("--robust", "TOLERANCES", options.robust,
             "Optimise projections that also print if the printer deviates from its settings by up to these "
             "tolerances, e.g. 'axis=0.5px,index=0.005,angle=0.25deg,radius=0.2%,lamp=3%,psf=0.05mm': " +
                 join(all, ", ") +
                 ". The word calibration sets the tolerances to twice the standard deviations in the printer's current "
                 "calibration records (axis and radius from edges, angle from latency, psf from beam); tolerances that "
                 "are also given (calibration,lamp=3%) take precedence. The report contains the figures of merit at "
                 "each tolerance.")
      .only_with(in_vial)
      .only_with(readers("--robust"))
      .excludes({"--grey-target"});
  app.brief("Print well also if the printer deviates by these, e.g. 'axis=0.5px,lamp=3%'.");
  app.flag("--tolerances", options.tolerances,
           "State which deviation of the printer ends the print first, and at which value. Costs 40 to 80 dose "
           "computations, as 20 to 40 iterations do.")
      .only_with(in_vial)
      .excludes({"--robust", "--grey-target", "--slices", "--delivered"});
}

void declare_grey_levels(cli::App& app, Options& options) {
  app.group("Grey levels of the projector");
  app.option("--bits", "N", options.bits, {1, 16},
             "Quantise intensities to the grey levels of this bit depth, through projector.response. The report "
             "describes the intensities that are written.");
}

}  // namespace

void declare(cli::App& app, Options& options) {
  app.positional("TARGET", options.input, "Volume (VDB) with a grid 'target' of coverage 0...1.").reads();
  cli::add_output(app, options.output).writes_as({".exr", ".toml"});
  std::vector<std::string> methods = optimize::method_names();
  methods.insert(methods.begin(), "auto");
  app.choice(
      "--method", options.method, methods,
      std::string("Optimisation method. auto: ") + optimize::automatic_method + ", at least " +
          std::to_string(optimize::automatic_iterations) + " iterations, until " + optimize::automatic_until +
          " and on to the knee, where the last fifth of the cost in iterations widened the latitude by less than " +
          format_number(100 * (std::pow(1.25, optimize::automatic_rate) - 1), 2) + " %.");
  app.choice("--geometry", options.geometry, {"vial", "parallel"},
             "Beam model: refracted chief rays of the projector, which gives a projector sinogram, or ideal parallel "
             "beam, which gives a virtual sinogram for vam-resample in a third of the time.");
  app.brief("Beam: vial (refracted) or parallel. Default: vial.");
  app.option("--angles", "N", options.angles, {1, 100000}, "Number of stage angles over 360 degrees.");
  app.default_is("those of --init, else 360").brief("Number of stage angles over 360 degrees. Default: 360.");
  app.option("--detector-bins", "N", options.bins, {1, 65536},
             "Number of detector bins of a parallel beam, each one voxel wide.")
      .only_with(parallel);
  app.default_is("as many as cover the writable circle");
  app.option("--column-offset", "PX", options.column_offset_px, cli::any,
             "Distance in columns from projector.axis_column to the image of the axis, positive to the right: the "
             "projections are made for the axis there.")
      .only_with(in_vial);
  declare_poses(app, options);
  declare_constraints(app, options);
  declare_stopping(app, options);
  declare_parameters(app, options);
  declare_duration(app, options);
  declare_tolerances(app, options);
  declare_proof(app, options);
  declare_grey_levels(app, options);
  cli::add_printer(app, options.printer);
  app.group("Output and performance");
  app.option("--slices", "SLICES", options.slices,
             "Compute these slices only, counted from 0 at the bottom: FROM to TO - 1 as FROM:TO, or the I-th of N "
             "similar shares as I/N, which begin at multiples of 64. vam-convert join makes of such pieces the stack "
             "of the whole part, with the same images and attributes. For level rays (projector.telecentric, "
             "--geometry parallel): rays that climb couple all slices (IMPLEMENTATION NOTES). "
             "The report describes these slices.");
  app.excludes({"--budget", "--robust", "--tradeoff", "--certify", "--bits", "--poses", "--helix", "--wobble-record"});
  cli::add_report(app, options.report);
  cli::add_stack_output(app, options.stack.half, options.stack.compression);
  cli::add_threads(app);
  app.usual({"--output", "--method", "--geometry", "--angles", "--iterations", "--until", "--shortest", "--turns",
             "--robust", "--checkpoint", "--printer", "--set", "--report"});
}

}  // namespace vam::optimize_tool
