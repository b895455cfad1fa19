// SPDX-License-Identifier: GPL-3.0-or-later
#include "vam-dose/expose.hpp"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "base/compute/memory.hpp"
#include "base/compute/slab_lanes.hpp"
#include "base/error.hpp"
#include "base/index.hpp"
#include "base/log/log.hpp"
#include "base/log/progress.hpp"
#include "base/text/text.hpp"
#include "io/exr/stack.hpp"
#include "io/stream/stream.hpp"
#include "light/blur/blur_stream.hpp"
#include "light/grids/dose_grid.hpp"
#include "light/simulation/dose_stream.hpp"
#include "light/simulation/simulation.hpp"
#include "model/dose/dose_spread.hpp"
#include "model/grid_size.hpp"
#include "model/metadata.hpp"
#include "resin/absolute_dose.hpp"
#include "session/exposure.hpp"
#include "session/volumes.hpp"
#include "vam-dose/insert.hpp"
#include "vam-dose/sink.hpp"

namespace vam::dose_tool {

namespace {

constexpr int batch = 64;               // slices a pass
constexpr double climbing_slices = 90;  // of dose in memory where rays climb

/// Of virtual sinograms those of these tools are known to have been asked for.
void warn_about(const Options& options, const Light& light, bool projector) {
  const light::LightSeen& seen = light.seen();
  if (seen.negative == 0 || (!projector && light.sealed())) return;
  warn(io::input_name(options.inputs.front()) + ": " + format_number(100 * seen.negative / seen.values, 3) +
       " % of the intensities are negative, the minimum is " + format_number(seen.least, 3) + ", the maximum " +
       format_number(seen.peak, 3) +
       (!projector || options.negative == "keep" ? "; kept, though no projector can show them" : "; set to 0"));
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

/// Weights of rays that miss a voxel are 0 but for rounding.
void clip(Image& dose) {
  for (float& value : dose.values) value = std::max(value, 0.0F);
}

/// Every slice by its own row, a batch at a time.
void expose_slices(Light& light, int count, const light::Simulation& simulation, int first, Insert& insert,
                   Blurred& sink) {
  Progress progress("dose", count);
  light.begin(batch);
  auto negative = light.seen().negative;
  for (std::vector<Image> slices = light.next(); !slices.empty(); slices = light.next()) {
    const bool has_negative = light.seen().negative != negative;
    negative = light.seen().negative;
    std::vector<Image> doses(slices.size());
    const std::vector<Image> inserts = insert.slices(first, count_of(slices));
    simulation.dose(slices, doses, inserts);
    insert.look_for_dark(simulation, first, inserts);
    first += count_of(slices);
    for (Image& dose : doses) {
      if (!has_negative) clip(dose);
      sink.add(dose);
    }
    progress.tick(static_cast<long>(slices.size()));
  }
  sink.finish();
}

/// Every slice is exposed by all rows whose rays pass through it.
void expose_volume(Light& light, int count, const light::Simulation& simulation, int slices, Insert& insert,
                   Blurred& sink) {
  const std::vector<Image> inserts = insert.slices(0, slices);
  Progress progress("dose", count);
  light.begin(lanes / 2);
  light::DoseStream stream(simulation, inserts, [&](Image dose) { sink.add(dose); });
  for (std::vector<Image> some = light.next(); !some.empty(); some = light.next()) {
    const auto read = static_cast<long>(some.size());
    stream.push(std::move(some));
    progress.tick(read);
  }
  stream.finish();
  insert.look_for_dark(simulation, 0, inserts);
  sink.finish();
}

/// Of a sinogram whose plan does not tell it.
double peak_of(const std::string& path, const model::StackInfo& info, const model::Printer& printer) {
  if (!model::threshold_dose(info.extra) || !resin::dose_per_radian_mj_cm3(printer)) return 1;
  if (path == "-")
    throw Error{Fault::usage,
                "SINOGRAM: how long its print takes, and diffuses, is not known before the end of a pipe; "
                "give a file, or --diffusion-time"};
  io::StackReader reader(path);
  Image image;
  float peak = 0;
  for (model::ImageInfo about; reader.next(image, about);)
    peak = std::max(peak, *std::max_element(image.values.begin(), image.values.end()));
  return static_cast<double>(peak);
}

/// Of the print: as many turns as were shown, as frames that are shown once take, or as its exposure.
double seconds_of(const Options& options, const model::Printer& printer, const model::StackInfo& info,
                  double shown_turns) {
  if (options.diffusion_time_s || printer.resin.diffusion_mm2_s == 0) return options.diffusion_time_s.value_or(0);
  if (!options.shown.empty()) return model::seconds_of(printer.stage, shown_turns);
  const std::string name = io::input_name(options.inputs.front());
  const session::GivenExposure given{.full_scale = options.full_scale, .sets = options.printer.sets};
  auto exposure = session::exposure_of(name, info, printer, 0, given);
  if (exposure.full_scale == 0)
    exposure = session::exposure_of(name, info, printer, peak_of(options.inputs.front(), info, printer), given);
  return model::seconds_of(printer.stage, exposure.turns);
}

}  // namespace

Exposed expose(Light& light, const model::StackInfo& info, const Options& options, const model::Printer& printer,
               const Place& place, io::SparseVolume& volume) {
  const bool projector = info.space == model::Space::projector;
  const auto climb = options.in_plane ? light::Climb::flat : light::Climb::follow;
  const auto require_slices = [&](double slices) {
    require_memory(sizeof(float) * slices * static_cast<double>(place.grid.slice_size()),
                   options.inputs.front() + ": " + model::size_text(place.grid), "use larger voxels");
  };
  require_slices(climbing_slices);  // the fewer, before rays are traced
  const light::Simulation simulation(printer, options.alignment, info, place.grid, climb);
  const int first = simulation.climbs() ? 0 : light::first_slice(place.grid, info);
  std::optional<model::Circle> judged;
  if (place.target != nullptr) judged = model::judged_circle(place.grid, place.judged_mm);
  Insert insert(place.insert, place.target, place.grid, info);
  Sink sink(volume, place, insert, first, judged);

  Exposed exposed;
  exposed.shown_turns = light.turns();
  if (!options.no_blur) {
    exposed.seconds = seconds_of(options, printer, info, exposed.shown_turns);
    model::warn_of_diffusion(printer.resin, exposed.seconds);
    exposed.blur_mm = model::spread_mm(printer.resin, exposed.seconds);
  }
  Blurred blurred(exposed.blur_mm / place.grid.voxel_mm, sink);
  exposed.climbs = simulation.climbs();
  if (exposed.climbs) {
    expose_volume(light, info.count, simulation, place.grid.nz, insert, blurred);
  } else {
    require_slices(3.0 * batch);
    expose_slices(light, info.count, simulation, first, insert, blurred);
  }
  exposed.light = light.seen();
  exposed.doses = sink.range();
  exposed.metrics = sink.judged();
  if (judged) exposed.outside = sink.outside();
  if (insert.there() && place.target != nullptr) exposed.dark_part_voxels = insert.dark_part_voxels();
  warn_about(options, light, projector);
  session::warn_of_shadowed_voxels(options.like, insert.dark_part_voxels());
  return exposed;
}

}  // namespace vam::dose_tool
