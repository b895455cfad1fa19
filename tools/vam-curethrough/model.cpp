// SPDX-License-Identifier: GPL-3.0-or-later
// The cure by a stack of slices, or by the ordinary slices of a part.
#include <algorithm>
#include <memory>
#include <optional>
#include <string>

#include "base/compute/parallel.hpp"
#include "base/error.hpp"
#include "base/index.hpp"
#include "base/log/progress.hpp"
#include "base/text/json.hpp"
#include "base/text/text.hpp"
#include "io/settings/sealed_text.hpp"
#include "io/stream/file_type.hpp"
#include "io/stream/stream.hpp"
#include "model/dose/dose_metrics.hpp"
#include "model/metadata.hpp"
#include "resin/curethrough/cure_map.hpp"
#include "resin/curethrough/stack_dose.hpp"
#include "session/printer.hpp"
#include "vam-curethrough/figures.hpp"
#include "vam-curethrough/part.hpp"
#include "vam-curethrough/print.hpp"
#include "vam-curethrough/slices.hpp"
#include "vam-curethrough/subcommands.hpp"

namespace vam::curethrough {

namespace {

struct ModelOptions {
  std::string input = "-";
  PartOptions part;
  PrintOptions print;
  std::string output;
  std::string section;
  std::optional<int> row;
  std::optional<int> column;
  std::optional<double> slice_um;
  std::string report;
};

constexpr int slices_a_block = resin::StackDose::block_slices;

bool is_volume(const std::string& path) { return path == "-" || io::file_type(path) == io::FileType::volume; }

// The ordinary slices of a part: maximum intensity in it, minimum outside.
SliceSource plain_slices(const std::shared_ptr<PartFile>& part, float dark) {
  const model::Grid& grid = part->grid();
  SliceSource slices{part->name(), grid.nx, grid.ny, grid.nz, {}, part->history(), {}};
  static constexpr int batch = 8;
  auto slab = std::make_shared<std::vector<float>>(grid.slice_size() * batch);
  slices.read = [part, slab, dark](int n, Image& slice) {
    const model::Grid& shape = part->grid();
    if (n % batch == 0) part->columns().unpack(n, std::min(batch, shape.nz - n), slab->data());
    if (slice.width != shape.nx || slice.height != shape.ny) slice = Image(shape.nx, shape.ny);
    const float* solid = slab->data() + static_cast<std::size_t>(n % batch) * shape.slice_size();
    for (std::size_t p = 0; p < slice.size(); ++p) slice.values[p] = std::max(solid[p], dark);
  };
  return slices;
}

struct Inputs {
  std::shared_ptr<PartFile> part;  // the design, null without one
  SliceSource slices;
  PrintSettings print;
};

// The stack's facts about its print apply where the command line gives none.
PrintOptions with_facts(const cli::App& app, PrintOptions options, const SliceSource& slices) {
  const auto speed = model::stated_number(slices.facts, "vam:speed_mm_h");
  if (speed && *speed > 0 && !app.given("--print-speed")) options.speed_mm_h = *speed;
  const bool layered = model::stated_text(slices.facts, "vam:exposure") == "layered";
  if (layered && !app.given("--exposure-mode")) options.exposure = "layered";
  return options;
}

double slice_height_um(const ModelOptions& options, const Inputs& in) {
  if (in.part) return in.part->slice_um();
  if (options.slice_um) return *options.slice_um;
  const auto height = model::stated_number(in.slices.facts, "vam:slice_mm");
  if (height && *height > 0) return *height * 1e3;
  throw Error{Fault::usage, in.slices.name + ": the slice height is not known; give --slice-height or --target"};
}

Inputs open_inputs(const cli::App& app, const ModelOptions& options) {
  Inputs in{nullptr, {}, resolve(options.print, 50)};
  PartOptions design = options.part;
  const bool plain = is_volume(options.input);
  if (plain) app.require_for("volumes", io::input_name(options.input));
  if (plain) design.path = options.input;
  if (design.path.empty()) app.require_for("slices alone", options.input);
  if (!design.path.empty()) in.part = std::make_shared<PartFile>(design, exposure_of(options.print));
  if (!plain) in.slices = open_slices(options.input, in.print.response);
  const PrintOptions print = with_facts(app, options.print, in.slices);
  in.print = resolve(print, slice_height_um(options, in));
  if (plain) {
    in.slices = plain_slices(in.part, static_cast<float>(in.print.limits.phi_min / in.print.limits.phi_max));
    return in;
  }
  if (!in.part) return in;
  const model::Grid& grid = in.part->grid();
  if (grid.nx != in.slices.width || grid.ny != in.slices.height || grid.nz > in.slices.count) {
    throw Error{Fault::data, in.slices.name + ": " + std::to_string(in.slices.count) + " slices of " +
                                 std::to_string(in.slices.width) + " x " + std::to_string(in.slices.height) +
                                 " pixels do not match " + in.part->name() + " of " + std::to_string(grid.nx) + " x " +
                                 std::to_string(grid.ny) + " x " + std::to_string(grid.nz) + " voxels"};
  }
  return in;
}

// The second reading: dose, cure map and section of a block of slices.
class Judge {
 public:
  Judge(const ModelOptions& options, const Inputs& in) : in_(in), grid_(grid_of(in)) {
    if (in.part) map_.emplace(grid_.nx, grid_.ny, in.slices.count, in.print.limits);
    if (!options.output.empty()) dose_.emplace("dose", grid_);
    plane_.row = options.row.value_or(grid_.ny / 2);
    plane_.column = options.column.value_or(grid_.nx / 2);
    if (plane_.row >= grid_.ny || plane_.column >= grid_.nx) {
      throw Error{Fault::usage, "--row, --column: " + std::to_string(plane_.row) + ", " +
                                    std::to_string(plane_.column) + " lies outside the slices of " +
                                    std::to_string(grid_.nx) + " x " + std::to_string(grid_.ny) + " pixels"};
    }
    plane_.light = plane_.cure = plane_.solid = Image(grid_.nx, in.slices.count);
    plane_.omega.assign(in.slices.count, 0);
  }

  void add(int first, const std::vector<Image>& light, const resin::StackDose& dose) {
    std::vector<float> centres(dose_ ? grid_.slice_size() * light.size() : 0);
    parallel_for(grid_.ny, [&](int y) { judge_row(first, light, dose, y, centres); });
    if (!dose_) return;
    const int count = count_of(light);
    if (in_.part) return in_.part->write(*dose_, first, count, centres);
    dose_->write_slices(first, count, centres.data());
  }

  std::optional<resin::CureMap> map_;
  std::optional<io::SparseVolume> dose_;
  PlaneFigure plane_;

 private:
  static model::Grid grid_of(const Inputs& in) {
    if (in.part) return in.part->extended(in.slices.count);
    return model::centred_grid(in.slices.width, in.slices.height, in.slices.count, in.print.process.slice_um * 1e-3);
  }

  void judge_row(int first, const std::vector<Image>& light, const resin::StackDose& dose, int y,
                 std::vector<float>& centres) {
    const auto width = static_cast<std::size_t>(grid_.nx);
    std::vector<float> below(light.size() * width);
    dose.replay_row(first, light, y, below.data());
    std::vector<float> solid(below.size());  // slices beyond the part are empty
    const int inside = in_.part ? std::clamp(in_.part->grid().nz - first, 0, count_of(light)) : 0;
    if (inside > 0) in_.part->columns().unpack_row(y, first, inside, solid.data(), width);
    for (std::size_t i = 0; i < light.size(); ++i) {
      const float* row = light[i].row(y);
      const float* next = below.data() + i * width;
      if (map_) map_->add_row(y, row, in_.print.limits.phi_max, next, solid.data() + i * width);
      if (y == plane_.row) keep_plane(first + static_cast<int>(i), row, next, solid.data() + i * width);
      if (dose_) fill_centres(row, next, centres.data() + i * grid_.slice_size() + product(y, width));
    }
  }

  void keep_plane(int n, const float* light, const float* below, const float* solid) {
    for (int x = 0; x < grid_.nx; ++x) {
      const double omega = centre(light[x], below[x]);
      const bool in_part = map_ && model::half_covered(solid[x]);
      plane_.light(x, n) = light[x];
      plane_.solid(x, n) = in_part ? 1.0F : 0.0F;
      const resin::Cure cure = resin::cure_of(omega, in_part);
      plane_.cure(x, n) = static_cast<float>(map_ || cure == resin::Cure::empty ? cure : resin::Cure::correct);
      if (x == plane_.column) plane_.omega[n] = omega;
    }
  }

  void fill_centres(const float* light, const float* below, float* out) const {
    for (int x = 0; x < grid_.nx; ++x) out[x] = static_cast<float>(centre(light[x], below[x]));
  }

  double centre(float light, float below) const {
    const double phi = in_.print.limits.phi_max * static_cast<double>(light);
    return resin::dose_at_centre(phi, static_cast<double>(below), in_.print.limits);
  }

  const Inputs& in_;
  model::Grid grid_;
};

void read_twice(const Inputs& in, Judge& judge) {
  resin::StackDose dose(in.print.limits, in.print.limits.phi_max);
  Progress progress("simulating", 2L * in.slices.count);
  Image slice;
  for (int n = 0; n < in.slices.count; ++n, progress.tick()) {
    in.slices.read(n, slice);
    dose.add(slice);
  }
  dose.turn();
  for (int n = 0; n < in.slices.count; n += slices_a_block) {
    std::vector<Image> light(static_cast<std::size_t>(std::min(slices_a_block, in.slices.count - n)));
    for (std::size_t i = 0; i < light.size(); ++i, progress.tick()) {
      in.slices.read(n + static_cast<int>(i), light[i]);
    }
    judge.add(n, light, dose);
  }
}

void declare(cli::App& app, ModelOptions& options) {
  options.part.path.clear();
  app.positional("SLICES", options.input,
                 "EXR frame stack, folder of numbered images, or a target volume (.vdb, or standard input): maximum "
                 "intensity in the part, minimum outside.")
      .reads();
  app.option("-o,--output", "FILE", options.output,
             "Write the dose at the centres of the voxels as a volume (grid dose, in full-cure doses).")
      .writes();
  app.option("--target", "FILE", options.part.path, "Target volume of the part, for the cure map.")
      .reads()
      .not_for({"volumes"});
  add_part(app, options.part, {"slices alone"});
  app.option("--slice-height", "UM", options.slice_um, {1, 10000},
             "Slice height of a folder of images without --target.")
      .excludes({"--target"})
      .not_for({"volumes"});
  app.group("Figure", {"--section"});
  app.option("--section", "FILE", options.section,
             "Plot an x-z section: slices, cure map, and intensity and dose along one column (.png, .pdf or .svg).");
  app.option("--row", "Y", options.row, {0, 1e6}, "Pixel row of the section.").default_is("the middle");
  app.option("--column", "X", options.column, {0, 1e6}, "Pixel column of the curves.").default_is("the middle");
  add_print(app, options.print);
  app.group("Report and performance");
  cli::add_report(app, options.report);
  cli::add_threads(app);
}

void run(const cli::App& app, ModelOptions& options) {
  if (session::print_printer(options.print.printer)) return;
  const Inputs in = open_inputs(app, options);
  Judge judge(options, in);
  read_twice(in, judge);
  if (judge.dose_) {
    judge.dose_->units = "full-cure doses";
    judge.dose_->history = in.slices.history;
    judge.dose_->history.push_back(app.history());
    judge.dose_->metadata = attributes(in.print.process);
    judge.dose_->metadata["vam:full_cure_dose_mj_cm3"] = format_number(in.print.process.full_cure_dose_mj_cm3, 9);
    io::write_volume(options.output, *judge.dose_);
  }
  Json report{{"process", to_json(in.print.process)}, {"slices", in.slices.count}};
  if (judge.map_) {
    const resin::CureTotals totals = judge.map_->finish();
    report.update(to_json(totals, in.print.process));
    if (options.output.empty() && options.report != "-") io::write_text("-", table_of(totals, in.print.process));
  }
  if (!options.section.empty()) draw_plane(options.section, judge.plane_, in.print);
  io::write_report(options.report, "vam-curethrough-model", report);
}

}  // namespace

void add_model(cli::App& app) {
  app.subcommand<ModelOptions>("model", "compute dose and cure map of slices", declare, run);
}

}  // namespace vam::curethrough
