#include "vam-dose/expose.hpp"

#include <string>
#include <utility>
#include <vector>

#include "base/error.hpp"
#include "base/log.hpp"
#include "base/memory.hpp"
#include "base/slab_lanes.hpp"
#include "base/text.hpp"
#include "io/exr/stack_batches.hpp"
#include "light/blur.hpp"
#include "light/dose_grid.hpp"
#include "light/dose_stream.hpp"
#include "light/simulation.hpp"
#include "model/grid_size.hpp"
#include "optics/frames.hpp"
#include "vam-dose/insert.hpp"
#include "vam-dose/shown.hpp"
#include "vam-dose/sink.hpp"

namespace vam::dose_tool {

namespace {

constexpr int batch = 64;               // slices a pass
constexpr double climbing_slices = 90;  // of dose in memory where rays climb

void warn_about(const Options& options, const light::LightSeen& seen, bool projector) {
  if (!projector || seen.negative == 0) return;
  warn(options.input + ": " + format_number(100 * seen.negative / seen.values, 3) +
       " % of the intensities are negative, the minimum is " + format_number(seen.least, 3) + ", the maximum " +
       format_number(seen.peak, 3) +
       (options.negative == "keep" ? "; kept, though no projector can show them" : "; set to 0"));
}

/// Doses of slices, in ascending order, through what beam and resin smear.
class Blurred {
 public:
  Blurred(double blur_px, Sink& sink)
      : sharp_(blur_px <= 0), sink_(sink), blur_(blur_px, [this](Image dose) { sink_.add(dose); }) {}
  void add(Image& dose) {
    if (sharp_) {
      sink_.add(dose);
    } else {
      blur_.push(dose);
    }
  }
  void finish() {
    if (!sharp_) blur_.finish();
    sink_.flush();
  }

 private:
  bool sharp_;
  Sink& sink_;
  light::VolumeBlur blur_;
};

/// Every slice by its own row, a batch at a time.
light::LightSeen expose_slices(io::StackReader& in, const light::Simulation& simulation,
                               const light::DisplayRange& light, const std::vector<double>& turns, int first,
                               Insert& insert, Blurred& sink) {
  light::LightSeen seen;
  Progress progress("dose", in.info().count);
  io::ReadAhead reader(in, batch);
  for (std::vector<Image> slices = reader.next(); !slices.empty(); slices = reader.next()) {
    light::shine(light, slices, seen);
    weigh(turns, slices);
    std::vector<Image> doses(slices.size());
    const std::vector<Image> inserts = insert.slices(first, static_cast<int>(slices.size()));
    simulation.dose(slices, doses, inserts);
    insert.look_for_dark(simulation, first, inserts);
    first += static_cast<int>(slices.size());
    for (Image& dose : doses) sink.add(dose);
    progress.tick(static_cast<long>(slices.size()));
  }
  sink.finish();
  return seen;
}

/// Every slice by all rows whose rays come by.
light::LightSeen expose_volume(io::StackReader& in, const light::Simulation& simulation,
                               const light::DisplayRange& light, const std::vector<double>& turns, int slices,
                               Insert& insert, Blurred& sink) {
  light::LightSeen seen;
  const std::vector<Image> inserts = insert.slices(0, slices);
  Progress progress("dose", in.info().count);
  io::ReadAhead reader(in, lanes / 2);
  light::DoseStream stream(simulation, inserts, [&](Image dose) { sink.add(dose); });
  for (std::vector<Image> some = reader.next(); !some.empty(); some = reader.next()) {
    light::shine(light, some, seen);
    weigh(turns, some);
    const auto count = static_cast<long>(some.size());
    stream.push(std::move(some));
    progress.tick(count);
  }
  stream.finish();
  insert.look_for_dark(simulation, 0, inserts);
  sink.finish();
  return seen;
}

/// Diffusion lasts as long as the print: as many turns as were shown, as frames that are shown once take, or as the
/// stage makes.
double blur_mm(const Options& options, const model::Printer& printer, const model::StackInfo& info,
               double shown_turns) {
  if (options.no_blur) return 0;
  const double usual = model::repeat(info.poses) ? printer.stage.turns : optics::turns_of(info);
  const double turns = options.shown.empty() ? usual : shown_turns;
  const double seconds = options.diffusion_time_s.value_or(model::seconds_of(printer.stage, turns));
  return light::spread_mm(printer.resin.psf_mm, printer.resin.diffusion_mm2_s, seconds);
}

}  // namespace

Exposed expose(io::StackReader& in, const model::StackInfo& info, const Options& options, const model::Printer& printer,
               const Place& place, io::SparseVolume& volume) {
  const bool projector = info.space == model::Space::projector;
  if (options.in_plane && !projector) {
    throw Error{Fault::usage, "--in-plane: applies to a projector sinogram; the beams of a virtual one are level"};
  }
  const auto climb = options.in_plane ? light::Climb::flat : light::Climb::follow;
  const light::Simulation simulation(printer, options.alignment, info, place.grid, climb);
  const int first = simulation.climbs() ? 0 : light::first_slice(place.grid, info);
  const light::DisplayRange light{projector && options.negative == "clip", options.full_scale,
                                  printer.projector.min_intensity_mw_cm2 / printer.projector.max_intensity_mw_cm2};
  const std::vector<double> turns = shown_turns(options, info, printer);
  std::optional<model::Circle> judged;
  if (place.target != nullptr) judged = model::writable_circle(place.grid, place.judged_mm);
  Insert insert(place.insert, place.target, place.grid, info);
  Sink sink(volume, place, insert, first, judged);

  Exposed exposed;
  for (const double t : turns) exposed.shown_turns += t / static_cast<double>(turns.size());
  exposed.blur_mm = blur_mm(options, printer, info, exposed.shown_turns);
  Blurred blurred(exposed.blur_mm / place.grid.voxel_mm, sink);
  exposed.climbs = simulation.climbs();
  require_memory(
      sizeof(float) * (exposed.climbs ? climbing_slices : 3.0 * batch) * static_cast<double>(place.grid.slice_size()),
      options.input + ": " + model::size_text(place.grid), "use larger voxels");
  exposed.light = exposed.climbs ? expose_volume(in, simulation, light, turns, place.grid.nz, insert, blurred)
                                 : expose_slices(in, simulation, light, turns, first, insert, blurred);
  exposed.doses = sink.range();
  exposed.metrics = sink.judged();
  if (judged) exposed.outside = sink.outside();
  if (insert.there() && place.target != nullptr) exposed.dark_part_voxels = insert.dark_part_voxels();
  warn_about(options, exposed.light, projector);
  if (insert.dark_part_voxels() > 0) {
    warn(options.like + ": " + std::to_string(insert.dark_part_voxels()) +
         " voxels of the part are in the insert's shadow from all sides; they will not print");
  }
  return exposed;
}

}  // namespace vam::dose_tool
