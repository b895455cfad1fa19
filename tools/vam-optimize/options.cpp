// SPDX-License-Identifier: GPL-3.0-or-later
#include "vam-optimize/options.hpp"

#include <map>
#include <vector>

#include "base/text.hpp"
#include "optimize/methods/automatic.hpp"
#include "optimize/run/slice_figures.hpp"

namespace vam::optimize_tool {

namespace {

/// "fbp, dose-norm: ", the methods that read the option.
std::string readers(const std::string& flag, const std::string& others = "") {
  const auto names =
      optimize::method_names([&](const optimize::MethodEntry& entry) { return optimize::reads(entry, flag); });
  return join(names, ", ") + others + ": ";
}

/// "0 (fbp), 1 (dose-norm), 30 (cal, osmo)"
std::string default_iterations() {
  std::map<int, std::vector<std::string>> names;
  for (const auto& entry : optimize::method_table()) names[entry.iterations].push_back(entry.name);
  std::vector<std::string> texts;
  for (const auto& [count, methods] : names) texts.push_back(std::to_string(count) + " (" + join(methods, ", ") + ")");
  return join(texts, ", ");
}

/// "0.03 (cal), 0.05 (bclp, --grey-target)"
std::string default_softness() {
  std::map<double, std::vector<std::string>> names;
  for (const auto& entry : optimize::method_table()) {
    if (optimize::reads(entry, "--softness")) names[entry.softness].push_back(entry.name);
  }
  names[optimize::usual_softness].emplace_back("--grey-target");
  std::vector<std::string> texts;
  for (const auto& [width, methods] : names) texts.push_back(format_number(width) + " (" + join(methods, ", ") + ")");
  return join(texts, ", ");
}

void declare_poses(cli::App& app, Options& options) {
  app.group("Poses of vial and part");
  app.option("--poses", "FILE", options.poses,
             "Pose of the vial or the part in every frame: a table (CSV) with the columns "
             "angle_deg,dx_mm,dy_mm,dz_mm,moves, one line per frame, 360 / --angles degrees apart, for any number of "
             "turns. The table is stored in the stack.")
      .reads();
  app.option("--helix", "MM", options.helix_mm, cli::any,
             "For parts taller than the image: lift of the vial per turn (negative: downwards), over the number of "
             "turns in which the whole part passes the image.");
  app.option("--wobble-record", "RECORD", options.wobble_record,
             "Record of vam-calibrate edges or axis with the wobble of the vial, whose axis circles the rotation axis; "
             "the projections follow it.")
      .reads();
}

void declare_constraints(cli::App& app, Options& options) {
  app.group("Target constraints");
  app.option("--dose-low", "DOSE", options.demands.window.low, cli::non_negative,
             "LOW: upper bound on the dose of void voxels.");
  app.option("--dose-high", "DOSE", options.demands.window.high, cli::positive,
             "HIGH: lower bound on the dose of part voxels.");
  app.option("--surface-margin", "MM", options.surface_margin_mm, cli::non_negative,
             "Leave voxels within this distance of the part's surface unconstrained.");
  app.flag("--free-surface", options.demands.free_surface,
           readers("--free-surface") +
               "do not constrain the dose on the part's surface to the threshold: the process window is often wider, "
               "and the print smaller by half a voxel all around.");
  app.flag("--surface", options.demands.surface,
           "Constrain surface voxels, too: as part if at least half covered, else as void.");
  app.option("--weights", "FILE", options.weights,
             "Volume (VDB) with a grid 'weight', or with a single grid: relative cost of an error in each voxel. 0 "
             "leaves the voxel unconstrained.")
      .reads();
  app.default_is("the grid 'weight' of the target file, if present");
  app.flag("--grey-target", options.demands.grey,
           "The target specifies a dose (or response) for every voxel, to be met within --band.");
  app.choice("--void", options.void_rule, {"met", "below", "free"},
             "--grey-target: void, where the target is 0, must be 0 within --band (met) or not exceed --dose-low "
             "(below), or is unconstrained (free).")
      .needs({"--grey-target"});
  app.option("--void-weight", "W", options.void_weight, cli::positive,
             "Relative cost of an error in the void; that in the part is 1. Multiplies --weights.");
  app.option("--void-band", "EPSILON", options.void_band, cli::non_negative, "--grey-target: --band in the void.")
      .needs({"--grey-target"});
  app.default_is("--band");
  app.option("--band", "EPSILON", options.demands.band, {0, 0.5},
             readers("--band", ", --grey-target") + "maximum deviation of the resin's response from the target.");
  app.option("--band-volume", "FILE", options.band_volume,
             "Volume (VDB) with a grid 'tolerance', or with a single grid: --band for each voxel.")
      .reads();
  app.default_is("the grid 'tolerance' of the target file, if present");
  app.option("--resin-response", "CURVE", options.response,
             readers("--resin-response", ", --grey-target") +
                 "response of the resin to the dose: linear (the dose itself), step (from LOW to HIGH), logistic, or a "
                 "CSV file with columns dose,response, which also sets LOW and HIGH.");
  app.default_is("logistic; linear with --grey-target");
  app.option("--softness", "GAMMA", options.softness, cli::positive, "Width of the logistic response, as a dose.");
  app.default_is(default_softness());
}

void declare_stopping(cli::App& app, Options& options) {
  app.group("Stopping criteria");
  app.option("--iterations", "N", options.iterations, {0, 1000000}, "Maximum number of iterations.");
  app.default_is(default_iterations()).not_in_job().brief("Maximum number of iterations.");
  app.option("--until", "CONDITIONS", options.until,
             "Stop when all conditions hold, e.g. 'ver=0,pw>=0.1'. Figures of merit: " +
                 join(optimize::SliceFigures::names(), ", ") + ".");
  app.default_is(std::string(optimize::automatic_until) +
                 " with --method auto, with --shortest or without --iterations; else no condition")
      .not_in_job()
      .brief("Stop when all conditions hold, e.g. 'ver=0,pw>=0.1'.");
  app.option(
      "--patience", "N", options.limits.patience, {0, 1000000},
      "Stop when IoU + PW has not improved by 1e-4 in this number of iterations; 0 disables it. Where no goal is met, "
      "the result is that of the iteration with the largest IoU + PW (with --robust, and with apg while its "
      "loss constrains the surface, that of the last one), with 0 that of the last one.");
  app.not_in_job();
  app.option("--init", "SINOGRAM", options.init, "Initial projections (EXR, of the same size).").reads();
  app.option("--delivered", "DOSE", options.delivered,
             readers("--delivered") +
                 "dose (VDB, in mJ/cm3) that the resin has received already, as of vam-dose --shown: the projections "
                 "complete it to the target's, the threshold being resin.critical_dose_mj_cm3. --init are the "
                 "projections for the whole dose, of which the optimisation starts with the share that is left; "
                 "figures of merit and report are those of both doses together. Several doses add up.")
      .reads()
      .needs({"--init"});
  app.option("--budget", "SECONDS", options.budget_s, cli::positive,
             "Time for the computation as a whole: no iteration begins that would not leave enough of it for the rest. "
             "The coarser levels of auto take at most half. The result depends on the speed of the machine.");
  app.not_in_job();
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
  app.option("--void-dose", "B", options.how.void_dose, {0, 1}, readers("--void-dose") + "target dose of the void.");
  app.option("--min-intensity", "VALUE", options.how.min_intensity, cli::any,
             readers("--min-intensity") + "lower bound on projected intensity.");
  app.choice(
      "--negative", options.negative, {"clip", "offset"},
      readers("--negative") +
          "set negative intensities to the lower bound, or subtract the minimum of a slice from all its intensities.");
  app.option("--power", "P", options.how.power, {1, 20}, readers("--power") + "exponent of the norm.");
  app.option("--max-intensity", "VALUE", options.max_intensity, cli::non_negative,
             readers("--max-intensity") + "upper bound on projected intensity; 0 is none.");
  app.default_is(format_number(optimize::usual_of_even) +
                 " times the even intensity, at which the mean dose is the threshold dose if every pixel is lit at "
                 "every angle; raised by half while the conditions of --until are not met");
}

/// How long the print takes, which the brightest pixel determines.
void declare_duration(cli::App& app, Options& options) {
  app.option("--turns", "N", options.turns, cli::positive,
             "Turns in which the print must be complete, with the brightest pixel at full grey: determines "
             "--max-intensity from resin.critical_dose_mj_cm3, resin.absorption_per_mm and "
             "projector.max_intensity_mw_cm2, and --diffusion-time. (vam-project --turns sets the number of turns "
             "shown.)");
  app.brief("Turns in which the print must be complete.");
  app.flag(
      "--shortest", options.shortest,
      readers("--max-intensity") +
          "find the shortest print that meets the conditions of --until: the maximum intensity begins at " +
          format_number(optimize::shortest_of_even) + " times the even intensity and is raised by " +
          format_number(100 * (optimize::shortest_raising.factor - 1)) + " % after every " +
          std::to_string(optimize::shortest_raising.next) +
          " iterations without success. auto searches on its coarsest voxels, which takes up to twice as long as a "
          "run; other methods take several times as long.");
  app.brief("Find the shortest print that meets --until.");
  app.option("--tradeoff", "FILE", options.tradeoff,
             readers("--max-intensity") +
                 "write the Pareto front of print duration and process window, as CSV or as a figure (.png, .pdf or "
                 ".svg), for "
                 "at least " +
                 std::to_string(optimize::front_points) + " maximum intensities, from " +
                 format_number(optimize::shortest_of_even) + " times the even intensity upwards in steps of " +
                 format_number(100 * (optimize::front_raising.factor - 1)) + " %. Takes " +
                 std::to_string(optimize::front_iterations) +
                 " iterations; the projections written are those of the last maximum intensity.")
      .writes({".csv", ".png", ".pdf", ".svg"});
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
      .writes({".vdb"});
}

void declare_tolerances(cli::App& app, Options& options) {
  std::vector<std::string> all;
  for (const model::Tolerance& one : model::tolerance_table) {
    all.push_back(std::string(one.name) + " (" + std::string(one.meaning) + ")");
  }
  app.group("Tolerances of the printer");
  app.option("--robust", "TOLERANCES", options.robust,
             readers("--robust") +
                 "optimise projections that also print if the printer deviates from its settings by up to these "
                 "tolerances, e.g. 'axis=0.5px,index=0.005,angle=0.25deg,radius=0.2%,lamp=3%,psf=0.05mm': " +
                 join(all, ", ") +
                 ". The word calibration sets the tolerances to twice the standard deviations in the printer's current "
                 "calibration records (axis and radius from edges, angle from latency, psf from beam); tolerances that "
                 "are also given (calibration,lamp=3%) take precedence. The report contains the figures of merit at "
                 "each tolerance.");
  app.brief("Print well also if the printer deviates by these, e.g. 'axis=0.5px,lamp=3%'.");
  app.option(
      "--yield-printers", "N", options.yield_printers, {0, 100000},
      "Number of random printers for the yield of --robust, each quantity distributed uniformly within its tolerance.");
  app.not_in_job();
}

void declare_beam(cli::App& app, Options& options) {
  app.group("Beam and resin");
  app.choice("--absorption-model", options.absorption_model, {"exact", "disc", "none"},
             "Absorption by the resin (resin.absorption_per_mm): exact; corrected once by the dose of a uniform disc, "
             "for parallel beams; or neglected.");
  app.choice(
      "--line-integrals", options.line_integrals, {"footprints", "fourier", "auto"},
      "Parallel beam in clear resin: sums along rays by the footprints of the voxels, as in vam-dose; by Fourier "
      "slices, to 1e-3 of the largest dose and several times as fast for large slices; or by the faster of both, "
      "by an estimate from sizes and numbers. Figures of merit are those of the doses so computed; vam-dose and "
      "vam-score judge by footprints.");
  app.flag("--no-blur", options.no_blur, "Do not compensate for point spread and diffusion.");
  app.option("--diffusion-time", "S", options.diffusion_time_s, cli::non_negative,
             "Time in which the light arrives, and the dose diffuses.");
  app.default_is("the duration of stage.turns turns");
}

void declare_grey_levels(cli::App& app, Options& options) {
  app.group("Grey levels of the projector");
  app.option("--bits", "N", options.bits, {1, 16},
             "Quantise intensities to the grey levels of this bit depth, through projector.response. The report "
             "describes the intensities that are written.");
  app.option("--full-scale", "VALUE", options.full_scale, cli::positive, "Intensity shown at full grey.")
      .needs({"--bits"});
  app.default_is("the largest of all projections");
  app.option(
         "--dither", "N", options.dither_turns, {1, 1000},
         "Carry the rounding error over to neighbouring columns and angles, as vam-project --dither N; N is 1, as a "
         "sinogram has the frames of one turn.")
      .needs({"--bits"});
}

}  // namespace

void declare(cli::App& app, Options& options) {
  app.positional("TARGET", options.input, "Volume (VDB) with a grid 'target' of coverage 0...1.").reads();
  cli::add_output(app, options.output).writes_as({".exr", ".toml"});
  std::vector<std::string> methods = optimize::method_names();
  methods.insert(methods.begin(), "auto");
  app.choice("--method", options.method, methods,
             std::string("Optimisation method. auto: ") + optimize::automatic_method +
                 " from coarse to fine, at least " + std::to_string(optimize::automatic_refinements) +
                 " iterations at full resolution (" + std::to_string(optimize::early_refinements) +
                 " where the print's surface is within tolerance by then), until " + optimize::automatic_until + ".");
  app.choice("--geometry", options.geometry, {"vial", "parallel"},
             "Beam model: refracted chief rays of the projector, which gives a projector sinogram, or ideal parallel "
             "beam, which gives a virtual sinogram for vam-resample in a third of the time.");
  app.brief("Beam: vial (refracted) or parallel. Default: vial.");
  app.option("--angles", "N", options.angles, {1, 100000}, "Number of stage angles over 360 degrees.");
  app.default_is("those of --init, else 360").brief("Number of stage angles over 360 degrees. Default: 360.");
  app.option("--detector-bins", "N", options.bins, {1, 65536},
             "Number of detector bins of a parallel beam, each one voxel wide.");
  app.default_is("as many as cover the writable circle");
  app.option("--column-offset", "PX", options.column_offset_px, cli::any,
             "Distance in columns from projector.axis_column to the image of the axis, positive to the right: the "
             "projections are made for the axis there.");
  declare_poses(app, options);
  declare_constraints(app, options);
  declare_stopping(app, options);
  declare_parameters(app, options);
  declare_duration(app, options);
  declare_tolerances(app, options);
  declare_proof(app, options);
  declare_beam(app, options);
  declare_grey_levels(app, options);
  cli::add_printer(app, options.printer);
  app.group("Output and performance");
  app.option(
      "--slices", "SLICES", options.slices,
      "Compute these slices only, counted from 0 at the bottom: FROM to TO - 1 as FROM:TO, or the I-th of N "
      "similar shares as I/N, which begin at multiples of 64. vam-convert join makes of such pieces the stack "
      "of the whole part, with the same images and attributes. "
      "For level rays (projector.telecentric, --geometry parallel): rays that climb couple all slices (IMPLEMENTATION "
      "NOTES). The report describes these slices. Does not apply to options that need the whole part: --budget, "
      "--robust, --tradeoff, --certify, --bits, --poses, --helix, --wobble-record.");
  cli::add_report(app, options.report);
  cli::add_stack_output(app, options.stack.half, options.stack.compression);
  cli::add_threads(app);
  app.usual({"--output", "--method", "--geometry", "--angles", "--iterations", "--until", "--shortest", "--turns",
             "--robust", "--checkpoint", "--printer", "--set", "--report"});
}

}  // namespace vam::optimize_tool
