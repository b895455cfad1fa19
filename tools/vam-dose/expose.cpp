// SPDX-License-Identifier: GPL-3.0-or-later
#include "vam-dose/expose.hpp"

#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "base/error.hpp"
#include "base/index.hpp"
#include "base/log.hpp"
#include "base/memory.hpp"
#include "base/parallel.hpp"
#include "base/progress.hpp"
#include "base/slab_lanes.hpp"
#include "base/text.hpp"
#include "dark_part.hpp"
#include "io/exr/stack_batches.hpp"
#include "io/stream/input_name.hpp"
#include "light/blur/blur_stream.hpp"
#include "light/blur/gaussian_blur.hpp"
#include "light/grids/dose_grid.hpp"
#include "light/simulation/dose_stream.hpp"
#include "light/simulation/simulation.hpp"
#include "model/grid_size.hpp"
#include "optics/projector_frames.hpp"
#include "resin/dither.hpp"
#include "response.hpp"
#include "vam-dose/insert.hpp"
#include "vam-dose/shown.hpp"
#include "vam-dose/sink.hpp"

namespace vam::dose_tool {

namespace {

constexpr int batch = 64;               // slices a pass
constexpr double climbing_slices = 90;  // of dose in memory where rays climb

void warn_about(const Options& options, const light::LightSeen& seen, bool projector) {
  if (!projector || seen.negative == 0) return;
  warn(io::input_name(options.input) + ": " + format_number(100 * seen.negative / seen.values, 3) +
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
  light::BlurStream blur_;
};

/// What the projector makes of the sinograms: a range, and on request the grey levels in it.
class Display {
 public:
  Display(const light::DisplayRange& range, const Options& options, const model::Projector& projector) : range_(range) {
    if (!options.bits) return;
    levels_.emplace(tool::response_of(projector), *options.bits);
    if (options.dither_turns) dither_.emplace(*levels_, *options.dither_turns);
  }

  void shine(std::span<Image> sinograms, light::LightSeen& seen) const {
    light::shine(range_, sinograms, seen);
    if (!levels_) return;
    parallel_for(count_of(sinograms), [&](int k) {
      if (dither_) {
        sinograms[k] = resin::dithered(sinograms[k], *dither_);
      } else {
        for (float& value : sinograms[k].values) value = levels_->intensity(levels_->level(value));
      }
    });
  }

 private:
  light::DisplayRange range_;
  std::optional<resin::GreyLevels> levels_;
  std::optional<resin::Dither> dither_;
};

/// Every slice by its own row, a batch at a time.
light::LightSeen expose_slices(io::StackReader& in, const light::Simulation& simulation, const Display& display,
                               const std::vector<double>& turns, int first, Insert& insert, Blurred& sink) {
  light::LightSeen seen;
  Progress progress("dose", in.info().count);
  io::ReadAhead reader(in, batch);
  for (std::vector<Image> slices = reader.next(); !slices.empty(); slices = reader.next()) {
    display.shine(slices, seen);
    weigh(turns, slices);
    std::vector<Image> doses(slices.size());
    const std::vector<Image> inserts = insert.slices(first, count_of(slices));
    simulation.dose(slices, doses, inserts);
    insert.look_for_dark(simulation, first, inserts);
    first += count_of(slices);
    for (Image& dose : doses) sink.add(dose);
    progress.tick(static_cast<long>(slices.size()));
  }
  sink.finish();
  return seen;
}

/// Every slice is exposed by all rows whose rays pass through it.
light::LightSeen expose_volume(io::StackReader& in, const light::Simulation& simulation, const Display& display,
                               const std::vector<double>& turns, int slices, Insert& insert, Blurred& sink) {
  light::LightSeen seen;
  const std::vector<Image> inserts = insert.slices(0, slices);
  Progress progress("dose", in.info().count);
  io::ReadAhead reader(in, lanes / 2);
  light::DoseStream stream(simulation, inserts, [&](Image dose) { sink.add(dose); });
  for (std::vector<Image> some = reader.next(); !some.empty(); some = reader.next()) {
    display.shine(some, seen);
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
    throw Error{Fault::usage, "--in-plane: applies to projector sinograms; the rays of a virtual one are horizontal"};
  }
  const auto climb = options.in_plane ? light::Climb::flat : light::Climb::follow;
  const light::Simulation simulation(printer, options.alignment, info, place.grid, climb);
  const int first = simulation.climbs() ? 0 : light::first_slice(place.grid, info);
  const bool rounded = options.bits.has_value();  // the response has what leaks at grey 0
  const light::DisplayRange range{
      projector && options.negative == "clip", options.full_scale,
      rounded ? 0 : printer.projector.min_intensity_mw_cm2 / printer.projector.max_intensity_mw_cm2};
  const Display display(range, options, printer.projector);
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
  exposed.light = exposed.climbs ? expose_volume(in, simulation, display, turns, place.grid.nz, insert, blurred)
                                 : expose_slices(in, simulation, display, turns, first, insert, blurred);
  exposed.doses = sink.range();
  exposed.metrics = sink.judged();
  if (judged) exposed.outside = sink.outside();
  if (insert.there() && place.target != nullptr) exposed.dark_part_voxels = insert.dark_part_voxels();
  warn_about(options, exposed.light, projector);
  tool::warn_of_dark_part(options.like, insert.dark_part_voxels());
  return exposed;
}

}  // namespace vam::dose_tool
