// vam-dose: the dose that sinograms leave in the resin.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "base/constants.hpp"
#include "base/error.hpp"
#include "base/log.hpp"
#include "base/text.hpp"
#include "cli/app.hpp"
#include "cli/common.hpp"
#include "io/exr_stack.hpp"
#include "io/report.hpp"
#include "io/stack_batches.hpp"
#include "io/stream.hpp"
#include "io/vdb.hpp"
#include "metrology/exposure.hpp"
#include "metrology/exposure_plan.hpp"
#include "metrology/simulation.hpp"
#include "model/circle.hpp"
#include "model/dose_metrics.hpp"
#include "optics/blur.hpp"
#include "optics/insert_shadow.hpp"
#include "printer.hpp"
#include "vam-dose/insert.hpp"

namespace {

using namespace vam;

constexpr int batch = 64;  // slices a pass; the fastest for the tracer

struct Options {
  std::string input = "-";
  std::string output = "-";
  std::string like;
  std::optional<double> size_mm;
  std::optional<double> full_scale;
  std::optional<double> seconds;
  bool no_blur = false;
  bool keep_negative = false;
  bool exposure_plan = false;
  double angle_offset_deg = 0;
  optics::Alignment alignment;
  std::string report;
  cli::PrinterOptions printer;
};

cli::Manual manual() {
  return {
      "vam-dose",
      "simulate the dose that a print leaves in the resin",
      {"vam-dose reads sinograms and writes the volume 'dose': the light that every voxel takes up in one turn of the "
       "vial. It is the judge of the chain before resin is spent: what reaches the same dose will print alike.",
       "A projector's sinograms (from vam-resample) are simulated by chief rays: for every voxel and stage angle the "
       "column whose ray passes through the voxel, refraction and Fresnel losses included, its light per width by the "
       "density of the rays at that depth, and absorption along the way through the resin. Virtual sinograms "
       "(vam-sinogram, vam-optimize) are back-projected along parallel rays, with absorption if the resin has any.",
       "A grid 'insert' in the volume of --like is an opaque object that is printed around (overprinting; vam-slice "
       "--insert): every ray ends at the first voxel that is at least half insert, so that all behind it is in shadow, "
       "and the insert itself takes up no dose. Voxels of the part that no ray reaches are counted "
       "(dark_part_voxels of the report) and warned about.",
       "The dose is in units of light times radian (an even light of 1 gives 2 pi at most), or in mJ/cm3 when the "
       "resin "
       "has resin.critical_dose_mj_cm3 and resin.absorption_per_mm: then the largest value of the stack, or "
       "--full-scale, is taken as projector.max_intensity_mw_cm2, and the report says how many turns and seconds the "
       "print takes at stage.speed_deg_s. With --exposure-plan the dose is that of a whole print: the fewest turns in "
       "which the middle of the process window reaches the critical dose, with the light dimmed to reach it exactly; "
       "vam-project --peak takes the report's peak_value.",
       "The point spread of the beam (resin.psf_mm) and the diffusion of dose while it prints (resin.diffusion_mm2_s) "
       "blur the volume; beyond its faces it is taken as dark."},
      {{"Will the disc grid print?",
        "vam-slice --shape disc-grid --voxel 0.2 -o part.vdb && vam-sinogram part.vdb --filter ram-lak --negative clip "
        "| "
        "vam-resample | vam-dose --like part.vdb -o dose.vdb && vam-score dose.vdb --target part.vdb"},
       {"What a telecentric correction would do on a projector that is not:",
        "vam-sinogram part.vdb --filter ram-lak --negative clip | vam-resample --set projector.telecentric=true | "
        "vam-dose --like part.vdb -o wrong.vdb"},
       {"A handle printed around the shaft of a screwdriver:",
        "vam-slice --shape handle --insert-shape screwdriver --voxel 0.8 -o handle.vdb && vam-optimize --angles 60 "
        "handle.vdb | vam-dose --like handle.vdb | vam-score --target handle.vdb"},
       {"The time a print takes in a resin that absorbs:",
        "vam-sinogram part.vdb --filter ram-lak --negative clip | vam-resample | vam-dose --like part.vdb --set "
        "resin.absorption_per_mm=0.06 --set resin.critical_dose_mj_cm3=100 --report time.json -o dose.vdb"}},
      {"Accuracy: chief-ray doses agree with rays counted one by one to 1e-3. A voxel holds the mean dose of its "
       "volume "
       "across the beam to second order; between columns light is linear. Outside the radius that is lit from all "
       "sides "
       "rays fold into caustics; there doses are good to some per cent. The rays' tilt along the axis is not followed: "
       "a slice lights its own voxels.",
       "Memory: the dose itself, the volume of --like, and three batches of 64 slices.",
       "Sources: Orth et al., Correcting ray distortion in tomographic additive manufacturing, Opt. Express 2021, eq "
       "8; "
       "Kelly et al., Volumetric additive manufacturing via tomographic reconstruction, Science 2019, eq 1."},
      {"vam-optimize", "vam-resample", "vam-score", "vam-view"}};
}

void declare(cli::App& app, Options& options) {
  app.positional("SINOGRAM", options.input, "Sinogram stack (EXR) of a projector, or a virtual one.");
  cli::add_output(app, options.output);
  cli::add_report(app, options.report);
  app.group("Volume");
  app.option("--like", "FILE", options.like,
             "Volume (VDB) whose voxels the dose takes; its grid 'target', if there, is the part of the report, its "
             "grid 'insert' an opaque object in the light.");
  app.option(
      "--size", "MM", options.size_mm, cli::positive,
      "Edge of the square around the axis. Without it all that is lit from every side (projector), or as wide as "
      "the sinogram (virtual). Voxels are as high as slices.");
  app.group("Light and resin");
  app.option("--full-scale", "VALUE", options.full_scale, cli::positive,
             "Sinogram value shown at full intensity; more is cut, less than projector.min_intensity_mw_cm2 raised. "
             "Without it the largest value of the stack, and no light at grey 0.");
  app.option("--seconds", "S", options.seconds, cli::non_negative,
             "Time for which dose diffuses. Without it the time of stage.turns turns.");
  app.flag("--exposure-plan", options.exposure_plan,
           "Choose whole turns and a fraction of full light that put the critical dose in the middle of the process "
           "window, and write the dose of that exposure. Needs --like with a target.");
  app.flag("--no-blur", options.no_blur, "Leave out point spread and diffusion.");
  app.flag("--keep-negative", options.keep_negative,
           "Take a projector's negative light as it is; no projector can show it. A virtual sinogram's always is.");
  app.group("Alignment");
  app.option("--column-offset", "PX", options.alignment.column_offset, cli::any,
             "The axis appears so many columns right of projector.axis_column.");
  app.option("--angle-offset", "DEG", options.angle_offset_deg, cli::any, "The part stands at stage angle plus this.");
  app.flag("--reverse", options.alignment.reverse, "The stage turns against stage.direction.");
  cli::add_printer(app, options.printer);
  app.group("Machine");
  cli::add_threads(app);
}

// Takes doses slice by slice into the volume, eight at a time, and into the report.
class Sink {
 public:
  /// judged: where part and void are told apart, if at all.
  Sink(io::SparseVolume& volume, const io::SparseVolume* target, const dose_tool::Insert& insert, int first,
       std::optional<model::Circle> judged)
      : volume_(volume), target_(target), insert_(insert), next_(first), judged_(judged) {}

  void add(Image& dose) {
    const std::vector<Image> inserts = insert_.slices(next_ + pending_, 1);
    if (!inserts.empty()) optics::darken(inserts, {&dose, 1});  // also of what blur has brought in
    Image part;
    if (target_ != nullptr) {
      part = Image(dose.width, dose.height);
      target_->read_slices(next_ + pending_, 1, part.values.data());
    }
    range_.add(dose, part);
    if (judged_) judge(dose, part);
    buffer_.insert(buffer_.end(), dose.values.begin(), dose.values.end());
    if (++pending_ + next_ % 8 == 8) flush();
  }
  void flush() {
    if (pending_ > 0) volume_.write_slices(next_, pending_, buffer_.data());
    next_ += pending_;
    pending_ = 0;
    buffer_.clear();
  }
  [[nodiscard]] const metrology::DoseRange& range() const { return range_; }
  [[nodiscard]] model::DoseMetrics judged() const { return statistics_.metrics(false); }

 private:
  void judge(const Image& dose, const Image& part) {
    for (int y = 0; y < dose.height; ++y) {
      for (int x = 0; x < dose.width; ++x) {
        const auto label = model::label_of(part(x, y));
        if (label == model::Label::part || judged_->contains(x, y)) statistics_.add(dose(x, y), label);
      }
    }
  }

  io::SparseVolume& volume_;
  const io::SparseVolume* target_;
  const dose_tool::Insert& insert_;
  int next_;
  int pending_ = 0;
  std::vector<float> buffer_;
  metrology::DoseRange range_;
  std::optional<model::Circle> judged_;
  model::DoseStatistics statistics_;
};

void scale_volume(io::SparseVolume& volume, double factor) {
  const model::Grid& grid = volume.grid();
  std::vector<float> slices(grid.slice_size() * 8);
  for (int k = 0; k < grid.nz; k += 8) {
    const int count = std::min(8, grid.nz - k);
    volume.read_slices(k, count, slices.data());
    for (float& value : slices) value = static_cast<float>(value * factor);
    volume.write_slices(k, count, slices.data());
  }
}

void warn_about(const Options& options, const metrology::LightSeen& seen, bool projector) {
  if (!projector || seen.negative == 0) return;
  warn(options.input + ": " + format_number(100 * seen.negative / seen.values, 3) +
       " % of the light is negative, the least " + format_number(seen.least, 3) + " of " + format_number(seen.peak, 3) +
       (options.keep_negative ? "; kept, though no projector can show it" : "; taken as 0"));
}

/// Where the dose goes: the voxels, what is known about them, and the part if there is one.
struct Place {
  std::vector<io::SparseVolume> like;
  const io::SparseVolume* target = nullptr;
  const io::SparseVolume* insert = nullptr;
  model::Grid grid;
};

Place place_of(const Options& options, const model::Printer& printer, const model::StackInfo& info) {
  Place place;
  if (options.like.empty()) {
    place.grid = metrology::dose_grid(printer, info, options.size_mm);
    return place;
  }
  place.like = io::read_volumes(options.like);
  for (const io::SparseVolume& volume : place.like) {
    if (volume.name() == "target") place.target = &volume;
    if (volume.name() == "insert") place.insert = &volume;
  }
  place.grid = (place.target != nullptr ? *place.target : place.like.front()).grid();
  return place;
}

io::SparseVolume empty_volume(const cli::App& app, const Place& place, const model::StackInfo& info) {
  io::SparseVolume volume("dose", place.grid);
  volume.metadata = info.extra;
  if (!place.like.empty()) {
    volume.metadata.insert(place.like.front().metadata.begin(), place.like.front().metadata.end());
  }
  volume.history = info.history;
  volume.history.push_back(app.history());
  return volume;
}

double blur_mm(const Options& options, const model::Printer& printer) {
  if (options.no_blur) return 0;
  const double seconds = options.seconds.value_or(printer.stage.turns * 360 / printer.stage.speed_deg_s);
  return optics::spread_mm(printer.resin.psf_mm, printer.resin.diffusion_mm2_s, seconds);
}

metrology::LightSeen expose(io::StackReader& in, const metrology::Simulation& simulation, const metrology::Light& light,
                            double blur_px, int first, dose_tool::Insert& insert, Sink& sink) {
  metrology::LightSeen seen;
  optics::VolumeBlur blur(blur_px, [&](Image dose) { sink.add(dose); });
  Progress progress("dose", in.info().count);
  io::ReadAhead reader(in, batch);
  for (std::vector<Image> slices = reader.next(); !slices.empty(); slices = reader.next()) {
    metrology::shine(light, slices, seen);
    std::vector<Image> doses(slices.size());
    const std::vector<Image> inserts = insert.slices(first, static_cast<int>(slices.size()));
    simulation.dose(slices, doses, inserts);
    insert.look_for_dark(simulation, first, inserts);
    first += static_cast<int>(slices.size());
    for (Image& dose : doses) {
      if (blur_px > 0) {
        blur.push(dose);
      } else {
        sink.add(dose);
      }
    }
    progress.tick(static_cast<long>(slices.size()));
  }
  blur.finish();
  sink.flush();
  return seen;
}

metrology::ExposurePlan planned(const model::DoseMetrics& doses, double scale, const model::Printer& printer,
                                const Options& options) {
  if (doses.part == 0 || doses.void_ == 0) {
    throw Error{Fault::data, options.like + ": its target has " + std::to_string(doses.part) + " voxels of part and " +
                                 std::to_string(doses.void_) + " of void; --exposure-plan needs both"};
  }
  if (doses.min_part <= doses.max_void) {
    warn("exposure: void takes up to " + format_number(scale * doses.max_void, 4) + " mJ/cm3 a turn, part from " +
         format_number(scale * doses.min_part, 4) + "; there is no process window, the best threshold is planned for");
  }
  return metrology::plan_exposure(scale * metrology::window_middle(doses), printer);
}

void simulate(const cli::App& app, const Options& options, const model::Printer& printer) {
  io::StackReader in(options.input);
  const model::StackInfo& info = in.info();
  io::require(options.input, info, model::Kind::sinogram);
  const bool projector = info.space == model::Space::projector;
  const Place place = place_of(options, printer, info);
  const int first = metrology::first_slice(place.grid, info);
  const metrology::Simulation simulation(printer, options.alignment, info, place.grid);
  io::SparseVolume volume = empty_volume(app, place, info);
  volume.metadata["vam:printer"] = io::printer_settings(printer);
  if (options.exposure_plan && place.target == nullptr) {
    throw Error{Fault::data, options.like + ": has no grid 'target'; --exposure-plan needs the part"};
  }
  std::optional<model::Circle> judged;
  if (options.exposure_plan) judged = model::writable_circle(place.grid, printer);
  dose_tool::Insert insert(place.insert, place.target, place.grid, info);
  Sink sink(volume, place.target, insert, first, judged);
  const double sigma_mm = blur_mm(options, printer);
  const metrology::Light light{projector && !options.keep_negative, options.full_scale,
                               printer.projector.min_intensity_mw_cm2 / printer.projector.max_intensity_mw_cm2};
  const metrology::LightSeen seen = expose(in, simulation, light, sigma_mm / place.grid.voxel_mm, first, insert, sink);
  warn_about(options, seen, projector);
  if (insert.dark_part_voxels() > 0) {
    warn(options.like + ": " + std::to_string(insert.dark_part_voxels()) +
         " voxels of the part lie in the insert's shadow from all sides; no light prints them");
  }

  const auto per_radian = metrology::dose_per_radian_mj_cm3(printer);
  const double full = options.full_scale ? 1.0 : seen.peak;
  const double scale = per_radian && full > 0 ? *per_radian / full : 1.0;
  std::optional<metrology::ExposurePlan> plan;
  if (options.exposure_plan) plan = planned(sink.judged(), scale, printer, options);
  if (per_radian) {
    scale_volume(volume, plan ? scale * plan->turns * plan->multiplier : scale);
    volume.units = "mJ/cm3";
  }
  if (plan) volume.metadata["vam:full_light_turns"] = format_number(plan->turns * plan->multiplier, 9);
  io::write_volume(options.output, volume);

  Json figures = sink.range().figures(printer, per_radian.has_value(), scale);
  figures["model"] = projector ? "chief rays" : "parallel";
  figures["full_scale"] = options.full_scale.value_or(seen.peak);
  figures["light_efficiency"] = seen.efficiency.value();
  figures["peak_intensity_mw_cm2"] = printer.projector.max_intensity_mw_cm2;
  if (plan) {
    metrology::add_to(figures, *plan);
    figures["peak_value"] = options.full_scale.value_or(seen.peak) / plan->multiplier;
  }
  figures["negative_fraction"] = seen.values > 0 ? seen.negative / seen.values : 0;
  if (insert.there() && place.target != nullptr) figures["dark_part_voxels"] = insert.dark_part_voxels();
  figures["blur_sigma_mm"] = sigma_mm;
  figures["absorption_per_mm"] = printer.resin.absorption_per_mm;
  // [CAL19]: at given power, exposure is shortest when light falls to 1/e over the radius.
  figures["absorption_for_shortest_print_per_mm"] = 1 / model::resin_radius_mm(printer.vial);
  io::write_report(options.report, "vam-dose/1", figures);
}

void run(const cli::App& app, Options& options) {
  const model::Printer printer = tool::load_printer(options.printer);
  if (tool::print_printer(options.printer, printer, options.output)) return;
  if (options.exposure_plan && options.like.empty()) {
    throw Error{Fault::usage, "--exposure-plan: needs to know the part; name its volume with --like"};
  }
  if (options.exposure_plan && !metrology::dose_per_radian_mj_cm3(printer)) {
    throw Error{Fault::usage,
                "--exposure-plan: needs resin.critical_dose_mj_cm3 and resin.absorption_per_mm, without which doses "
                "have no unit"};
  }
  if (!options.like.empty() && options.size_mm) {
    throw Error{Fault::usage, "--size: --like already says which voxels"};
  }
  options.alignment.angle_offset_rad = options.angle_offset_deg * rad_per_deg;
  io::refuse_same_file(options.input, options.output);
  simulate(app, options, printer);
}

}  // namespace

int main(int argc, char** argv) {
  cli::App app(manual());
  Options options;
  declare(app, options);
  return app.run(argc, argv, [&] { run(app, options); });
}
