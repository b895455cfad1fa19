#include "vam-dose/expose.hpp"

#include <string>
#include <vector>

#include "base/log.hpp"
#include "base/text.hpp"
#include "io/exr/stack_batches.hpp"
#include "light/blur.hpp"
#include "vam-dose/insert.hpp"
#include "vam-dose/sink.hpp"

namespace vam::dose_tool {

namespace {

constexpr int batch = 64;  // slices a pass; the fastest for the tracer

void warn_about(const Options& options, const light::LightSeen& seen, bool projector) {
  if (!projector || seen.negative == 0) return;
  warn(options.input + ": " + format_number(100 * seen.negative / seen.values, 3) +
       " % of the intensities are negative, the minimum is " + format_number(seen.least, 3) + ", the maximum " +
       format_number(seen.peak, 3) +
       (options.keep_negative ? "; kept, though no projector can show them" : "; set to 0"));
}

light::LightSeen shine_through(io::StackReader& in, const light::Simulation& simulation, const light::Light& light,
                               double blur_px, int first, Insert& insert, Sink& sink) {
  light::LightSeen seen;
  light::VolumeBlur blur(blur_px, [&](Image dose) { sink.add(dose); });
  Progress progress("dose", in.info().count);
  io::ReadAhead reader(in, batch);
  for (std::vector<Image> slices = reader.next(); !slices.empty(); slices = reader.next()) {
    light::shine(light, slices, seen);
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

}  // namespace

double blur_mm(const Options& options, const model::Printer& printer) {
  if (options.no_blur) return 0;
  const double seconds = options.seconds.value_or(printer.stage.turns * 360 / printer.stage.speed_deg_s);
  return light::spread_mm(printer.resin.psf_mm, printer.resin.diffusion_mm2_s, seconds);
}

Exposed expose(io::StackReader& in, const Options& options, const model::Printer& printer, const Place& place,
               io::SparseVolume& volume) {
  const model::StackInfo& info = in.info();
  const bool projector = info.space == model::Space::projector;
  const int first = light::first_slice(place.grid, info);
  const light::Simulation simulation(printer, options.alignment, info, place.grid);
  const light::Light light{projector && !options.keep_negative, options.full_scale,
                           printer.projector.min_intensity_mw_cm2 / printer.projector.max_intensity_mw_cm2};
  std::optional<model::Circle> judged;
  if (options.exposure_plan) judged = model::writable_circle(place.grid, printer);
  Insert insert(place.insert, place.target, place.grid, info);
  Sink sink(volume, place, insert, first, judged);

  Exposed exposed;
  const double blur_px = blur_mm(options, printer) / place.grid.voxel_mm;
  exposed.light = shine_through(in, simulation, light, blur_px, first, insert, sink);
  exposed.doses = sink.range();
  exposed.metrics = sink.judged();
  if (insert.there() && place.target != nullptr) exposed.dark_part_voxels = insert.dark_part_voxels();
  warn_about(options, exposed.light, projector);
  if (insert.dark_part_voxels() > 0) {
    warn(options.like + ": " + std::to_string(insert.dark_part_voxels()) +
         " voxels of the part are in the insert's shadow from all sides; they will not print");
  }
  return exposed;
}

}  // namespace vam::dose_tool
