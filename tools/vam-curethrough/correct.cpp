// SPDX-License-Identifier: GPL-3.0-or-later
// Slices that cure the part and nothing else.
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/compute/parallel.hpp"
#include "base/error.hpp"
#include "base/index.hpp"
#include "base/log/log.hpp"
#include "base/log/progress.hpp"
#include "base/text/json.hpp"
#include "base/text/text.hpp"
#include "cli/common.hpp"
#include "io/exr/stack.hpp"
#include "io/image/frame_sink.hpp"
#include "io/image/image_file.hpp"
#include "io/settings/sealed_text.hpp"
#include "io/stream/stream.hpp"
#include "optics/slice_place.hpp"
#include "resin/curethrough/gaps.hpp"
#include "resin/curethrough/slice_correction.hpp"
#include "session/printer.hpp"
#include "vam-curethrough/catalogue.hpp"
#include "vam-curethrough/part.hpp"
#include "vam-curethrough/print.hpp"
#include "vam-curethrough/slices.hpp"
#include "vam-curethrough/subcommands.hpp"

namespace vam::curethrough {

namespace {

struct CorrectOptions {
  PartOptions part;
  PrintOptions print;
  std::string output = "-";
  std::string png;
  std::string mask;
  std::string values = "intensity";
  resin::DoseLimit limit;
  double clear = 0.5;
  bool quantise = false;
  bool full_frame = false;
  std::string catalogue;
  std::vector<double> speeds_mm_h;
  std::string report;
  // Rows are runs of few values, on which ZIP is small and fast; RLE does not see the period of a float's four bytes.
  io::StackOptions stack{false, "zip"};
};

struct Job {
  PrintSettings print;
  PartFile part;
  resin::PartSurvey survey;
  resin::GapReport gaps;
  model::StackInfo info;
  int slices = 0;  // the extra ones included
};

Json figures(const CorrectOptions& options, const Job& job) {
  const double seconds = job.slices / frames_per_s(job.print.process);
  Json report{{"process", to_json(job.print.process)}};
  // JSON has no infinity.
  report["omega_max"] = std::isfinite(options.limit.omega_max) ? Json(options.limit.omega_max) : Json("inf");
  report["strong_base"] = options.limit.strong_base;
  report["slices"] = job.part.columns().slices();
  report["extra_slices"] = job.slices - job.part.columns().slices();
  report["duration_s"] = seconds;
  report["columns"] = job.survey.columns;
  report["features"] = job.survey.features;
  report["narrowest_gap_slices"] = job.gaps.narrowest;
  report["infeasible"] = {{"columns", job.gaps.infeasible_columns},
                          {"gaps", job.gaps.infeasible_gaps},
                          {"worst_excess", job.gaps.infeasible_gaps > 0 ? job.gaps.worst_dose - 1 : 0}};
  report["tight"] = {{"clear", options.clear},
                     {"columns", job.gaps.tight_columns},
                     {"gaps", job.gaps.tight_gaps},
                     {"worst_dose", job.gaps.worst_dose}};
  return report;
}

void write_mask(const std::string& path, const Image& mask) {
  GreyImage image(mask.width, mask.height, 8);
  for (std::size_t p = 0; p < mask.size(); ++p) {
    image.values[p] = static_cast<std::uint16_t>(std::min(255, static_cast<int>(mask.values[p]) * 128));
  }
  io::write_png(path, image);
}

std::vector<model::ImageInfo> time_stamps(const Job& job) {
  std::vector<model::ImageInfo> about(job.slices);
  for (std::size_t n = 0; n < about.size(); ++n) {
    about[n].time_s = static_cast<double>(n) / frames_per_s(job.print.process);
    about[n].has_time = true;
  }
  return about;
}

// Exact intensities, in printing order.
void write_exact(const CorrectOptions& options, const Job& job, const optics::SlicePlace& frame, float dark,
                 io::StackWriter& out) {
  resin::SliceCorrection correction(job.part.columns(), job.print.limits, options.limit, job.slices);
  Progress progress("correcting", job.slices);
  Image slice;
  Image placed;
  for (int n = 0; n < job.slices; ++n) {
    correction.next(slice);
    if (options.values == "grey") to_grey(slice, job.print.response);
    out.write(frame.place(slice, dark, placed));
    progress.tick();
  }
}

// Grey levels, chosen from the last slice upwards; all are kept until the stack can be written from the first down.
std::vector<GreyImage> all_levels(const CorrectOptions& options, const Job& job, const resin::GreyLevels& levels,
                                  const io::FrameFolder* folder, const optics::SlicePlace& frame) {
  std::vector<float> steps;
  for (int v = 0; v < levels.count(); ++v) steps.push_back(levels.intensity(v));
  resin::LevelCorrection correction(job.part.columns(), job.print.limits, options.limit, job.slices, steps);
  std::vector<GreyImage> kept(options.quantise ? static_cast<std::size_t>(job.slices) : 0);
  GreyImage slice(job.part.columns().width(), job.part.columns().height(), job.print.printer.projector.bits);
  Progress progress("correcting", job.slices);
  const auto times = time_stamps(job);
  std::vector<GreyImage> batch(product(2, threads()));  // encoded together
  for (int end = job.slices; end > 0;) {
    const int count = std::min(end, count_of(batch));
    for (int i = 0; i < count; ++i) {
      correction.previous(slice.values);
      batch[i] = frame.place(slice);
    }
    parallel_for(folder != nullptr ? count : 0, [&](int i) {
      const int n = end - 1 - i;
      folder->write(n, batch[i],
                    {{"vam:time_s", format_number(times[n].time_s, 9)},
                     {"vam:fps", format_number(frames_per_s(job.print.process), 9)},
                     {"vam:history", job.info.history.back()}});
    });
    for (int i = 0; i < (options.quantise ? count : 0); ++i) {
      kept[end - 1 - i] = std::move(batch[i]);
    }
    end -= count;
    progress.tick(count);
  }
  return kept;
}

void write_levels(const CorrectOptions& options, const Job& job, const resin::GreyLevels& levels,
                  const std::vector<GreyImage>& stack, io::StackWriter& out) {
  Image image(job.info.width, job.info.height);
  for (const GreyImage& slice : stack) {
    for (std::size_t p = 0; p < image.size(); ++p) {
      image.values[p] = options.values == "grey"
                            ? static_cast<float>(slice.values[p]) / static_cast<float>(levels.count() - 1)
                            : levels.intensity(slice.values[p]);
    }
    out.write(image);
  }
}

void warn_of_gaps(const std::string& name, const Job& job) {
  if (job.gaps.infeasible_columns == 0) return;
  warn(name + ": " + std::to_string(job.gaps.infeasible_columns) + " of " + std::to_string(job.survey.columns) +
       " columns have gaps of a single slice, whose dose exceeds the full-cure dose at any intensity; these gaps will "
       "fuse (--mask shows the columns)");
}

Job prepare(const cli::App& app, const CorrectOptions& options, bool writes) {
  PartFile source(options.part, exposure_of(options.print));
  const PrintSettings print = resolve(options.print, source.slice_um());
  Job job{print, std::move(source), {}, {}, {}, 0};
  const PartFile& part = job.part;
  job.survey = resin::survey(part.columns());
  if (job.survey.columns == 0) {
    throw Error{Fault::data, part.name() + ": no voxel reaches a coverage of " + format_number(part.threshold()) +
                                 "; there is nothing to print"};
  }
  if (writes) resin::require_printable(job.print.limits);
  job.gaps = resin::judge_gaps(part.columns(), job.print.limits, options.clear);
  if (writes) warn_of_gaps(part.name(), job);
  job.slices =
      part.columns().slices() + resin::extra_slices(job.survey.last_slice, part.columns().slices(), job.print.limits);
  const model::Grid& grid = part.grid();
  job.info.kind = model::Kind::frames;
  job.info.space = model::Space::projector;
  job.info.width = grid.nx;
  job.info.height = grid.ny;
  job.info.count = job.slices;
  job.info.pixel_mm = job.info.row_mm = grid.voxel_mm;
  job.info.z_start_mm = grid.y_mm(0);
  job.info.units = options.values == "grey" ? "grey" : "fraction of full intensity";
  job.info.extra = attributes(print.process);
  job.info.history = part.history();
  job.info.history.push_back(app.history());
  return job;
}

constexpr const char* no_stack = "--png or --catalogue alone";
constexpr const char* table_alone = "--catalogue alone";

/// What the slices are written to besides -o, and how.
void declare_output(cli::App& app, CorrectOptions& options) {
  app.option("--png", "FOLDER", options.png,
             "Write grey levels as numbered PNGs into a new FOLDER (projector.bits each); no stack is then written "
             "unless -o is given.")
      .writes();
  app.flag("--full-frame", options.full_frame,
           "Place the part in an image of projector.columns x projector.rows, with the axis at projector.axis_column, "
           "projector.axis_row.")
      .not_for({table_alone});
  app.group("Stack", {}, {no_stack});
  app.choice("--values", options.values, {"intensity", "grey"},
             "Pixels of the stack: fractions of the maximum intensity, for vam-project, or grey levels from 0 to 1, "
             "computed by the "
             "response.");
  app.flag("--quantise", options.quantise,
           "Write the grey levels of the PNGs to the stack instead of exact values; all slices are then in memory (2 "
           "bytes per pixel).");
  cli::add_stack_output(app, options.stack.half, options.stack.compression);
}

void declare(cli::App& app, CorrectOptions& options) {
  app.positional("PART", options.part.path, "Target volume (OpenVDB) of vam-slice.").reads();
  cli::add_output(app, options.output);
  declare_output(app, options);
  app.group("Correction", {}, {table_alone});
  app.option("--omega-max", "DOSE", options.limit.omega_max, {1, std::numeric_limits<double>::infinity()},
             "Maximum dose inside features, in full-cure doses; inf removes the limit.");
  app.flag("--strong-base", options.limit.strong_base,
           "Expose features on the platform at maximum intensity regardless of --omega-max: there is no resin behind "
           "them to cure.");
  app.option("--mask", "FILE", options.mask,
             "PNG map of the columns: 0 empty or without such gaps, 128 with a tight gap, 255 with a gap that fuses at "
             "any intensity.");
  app.group("Correction");
  app.option(
      "--clear", "DOSE", options.clear, {0, 1, true},
      "Maximum dose, in full-cure doses, at the least exposed point of a gap that counts as clear; gaps above it are "
      "reported as tight.");
  app.only_with({"--report", "--mask", "--catalogue"});
  add_part(app, options.part);
  app.group("Catalogue", {"--catalogue"});
  app.option("--catalogue", "FILE", options.catalogue,
             "CSV of resins with the columns name,absorbance_height_um,full_cure_dose_mj_cm3: print a table that "
             "compares them for this part. Slices are then written only with -o or --png.")
      .not_for({"stacks on standard output"});
  app.option("--print-speeds", "MM_H,...", options.speeds_mm_h, 0, "Platform speeds of the table.");
  app.default_is("20, 40, 60 and 80 % of the limit of each resin");
  add_print(app, options.print, {table_alone});
  app.group("Report and performance");
  cli::add_report(app, options.report);
  cli::add_threads(app);
}

void run(const cli::App& app, CorrectOptions& options) {
  if (session::print_printer(options.print.printer)) return;
  const bool stack = app.given("--output") || (options.png.empty() && options.catalogue.empty());
  const bool images = !options.png.empty();
  const std::string part = io::input_name(options.part.path);
  if (!stack) app.require_for(no_stack, part);
  if (!stack && !images) app.require_for(table_alone, part);
  if (stack && options.output == "-") app.require_for("stacks on standard output", part);
  Job job = prepare(app, options, stack || images);
  Json report = figures(options, job);
  if (!options.catalogue.empty())
    report["catalogue"] = compare(options.catalogue, options.speeds_mm_h, options.clear, job.print, job.part.columns());

  const auto frame = options.full_frame ? optics::SlicePlace("--full-frame", job.print.printer.projector, job.info)
                                        : optics::SlicePlace(job.info);
  frame.apply(job.info);
  std::optional<io::StackWriter> out;
  if (stack) out.emplace(options.output, job.info, time_stamps(job), options.stack);
  std::optional<io::FrameFolder> folder;
  if (images) folder.emplace(options.png);
  if (images || options.quantise) {
    const resin::GreyLevels levels(job.print.response, job.print.printer.projector.bits);
    const auto kept = all_levels(options, job, levels, folder ? &*folder : nullptr, frame);
    if (options.quantise) write_levels(options, job, levels, kept, *out);
  }
  const double darkest = options.values == "grey" ? 0 : job.print.limits.phi_min / job.print.limits.phi_max;
  if (stack && !options.quantise) write_exact(options, job, frame, static_cast<float>(darkest), *out);
  if (folder) folder->commit(time_stamps(job));
  if (out) out->commit();
  if (!options.mask.empty()) write_mask(options.mask, job.gaps.mask);
  io::write_report(options.report, "vam-curethrough-correct", report);
}

}  // namespace

void add_correct(cli::App& app) {
  app.subcommand<CorrectOptions>("correct", "compute slices without cure-through", declare, run);
}

}  // namespace vam::curethrough
