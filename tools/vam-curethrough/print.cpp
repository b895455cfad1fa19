#include "vam-curethrough/print.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/error.hpp"
#include "base/log.hpp"
#include "base/text.hpp"
#include "io/response_file.hpp"
#include "printer.hpp"

namespace vam::curethrough {

namespace {

constexpr int batch = 8;  // slices: one row of OpenVDB leaves

// Reverses the order of `count` slices of `size` values.
void reverse_slices(float* values, int count, std::size_t size) {
  for (int low = 0, high = count - 1; low < high; ++low, --high) {
    std::swap_ranges(values + static_cast<std::size_t>(low) * size, values + static_cast<std::size_t>(low + 1) * size,
                     values + static_cast<std::size_t>(high) * size);
  }
}

}  // namespace

void add_print(cli::App& app, PrintOptions& options) {
  app.group("Print");
  app.option("--speed", "MM_H", options.speed_mm_h, cli::positive, "Speed of the platform.");
  app.option(
      "--absorbance-height", "UM", options.absorbance_height_um, cli::positive,
      "Depth in which the light falls to a tenth (base 10); without it from resin.absorption_per_mm, else 2000.");
  app.option("--critical-dose", "MJ_CM3", options.critical_dose_mj_cm3, cli::positive,
             "Dose that cures; without it resin.critical_dose_mj_cm3, else 576.");
  app.option("--min-intensity", "MW_CM2", options.min_intensity_mw_cm2, cli::non_negative,
             "At the window, at grey 0; without it projector.min_intensity.");
  app.option("--max-intensity", "MW_CM2", options.max_intensity_mw_cm2, cli::positive,
             "At the window, at full grey; without it projector.max_intensity_mw_cm2.");
  app.option("--response", "FILE", options.response,
             "Measured grey response (CSV grey,intensity); without it projector.response, else a straight line. Its "
             "first entry sets the minimum intensity.");
  app.choice("--exposure", options.exposure, {"continuous", "layered"},
             "The platform moves all the time, or rests for each layer (exposed for slice height / speed).");
  cli::add_printer(app, options.printer);
}

Print resolve(const PrintOptions& options, double slice_um) {
  Print print{tool::load_printer(options.printer), {}, {}, resin::Response()};
  model::Projector& projector = print.printer.projector;
  if (options.min_intensity_mw_cm2) projector.min_intensity_mw_cm2 = *options.min_intensity_mw_cm2;
  if (options.max_intensity_mw_cm2) projector.max_intensity_mw_cm2 = *options.max_intensity_mw_cm2;
  if (!options.response.empty()) projector.response = options.response;

  resin::Process& process = print.process;
  process.exposure = options.exposure == "layered" ? resin::Exposure::layered : resin::Exposure::continuous;
  process.slice_um = slice_um;
  process.speed_mm_h = options.speed_mm_h;
  const model::Resin& resin = print.printer.resin;
  if (resin.absorption_per_mm > 0) process.absorbance_height_um = std::numbers::ln10 / resin.absorption_per_mm * 1e3;
  if (options.absorbance_height_um) process.absorbance_height_um = *options.absorbance_height_um;
  if (resin.critical_dose_mj_cm3) process.critical_dose_mj_cm3 = *resin.critical_dose_mj_cm3;
  if (options.critical_dose_mj_cm3) process.critical_dose_mj_cm3 = *options.critical_dose_mj_cm3;
  process.max_intensity_mw_cm2 = projector.max_intensity_mw_cm2;
  process.min_intensity_mw_cm2 = projector.min_intensity_mw_cm2;
  if (!projector.response.empty()) {
    print.response = resin::Response(io::read_response(projector.response));
    process.min_intensity_mw_cm2 = print.response.intensity(0) * process.max_intensity_mw_cm2;
  }
  print.limits = resin::limits_of(process);
  if (projector.response.empty()) print.response = resin::projector_response(projector);
  return print;
}

double frames_per_s(const resin::Process& process) { return process.speed_mm_h / 3600 / (process.slice_um * 1e-3); }

Json to_json(const resin::Process& process) {
  const resin::Limits limits = resin::limits_of(process);
  return {{"exposure", process.exposure == resin::Exposure::layered ? "layered" : "continuous"},
          {"slice_um", process.slice_um},
          {"absorbance_height_um", process.absorbance_height_um},
          {"critical_dose_mj_cm3", process.critical_dose_mj_cm3},
          {"speed_mm_h", process.speed_mm_h},
          {"frames_per_s", frames_per_s(process)},
          {"min_intensity_mw_cm2", process.min_intensity_mw_cm2},
          {"max_intensity_mw_cm2", process.max_intensity_mw_cm2},
          {"critical_intensity_mw_cm2", resin::critical_intensity_mw_cm2(process)},
          {"phi_min", limits.phi_min},
          {"phi_max", limits.phi_max}};
}

std::map<std::string, std::string> attributes(const resin::Process& process) {
  return {{"vam:exposure", process.exposure == resin::Exposure::layered ? "layered" : "continuous"},
          {"vam:slice_mm", format_number(process.slice_um * 1e-3, 9)},
          {"vam:speed_mm_h", format_number(process.speed_mm_h, 9)},
          {"vam:fps", format_number(frames_per_s(process), 9)}};
}

void add_part(cli::App& app, PartOptions& options) {
  app.choice("--platform", options.platform, {"bottom", "top"},
             "Which end of the volume sticks to the platform and is printed first; the light comes from the other.");
  app.option("--threshold", "FRACTION", options.threshold, {0, 1, true},
             "Coverage from which on a voxel belongs to the part.");
}

PartSource::PartSource(const PartOptions& options)
    : options_(options),
      name_(options.path == "-" ? "stdin" : options.path),
      volume_(io::read_volume(options.path, "target")) {
  const auto stretch = volume_.metadata.find("vam:stretch_z");
  const auto factor = stretch == volume_.metadata.end() ? std::nullopt : parse_number(stretch->second);
  if (factor && std::fabs(*factor - 1) > 1e-6) {
    warn(name_ + ": stretched along z by " + format_number(*factor) +
         " for a vial, which this printer does not have; slice with --stretch-z 1");
  }
}

void PartSource::read(int first, int count, float* out) const {
  if (options_.platform == "bottom") return volume_.read_slices(first, count, out);
  volume_.read_slices(grid().nz - first - count, count, out);
  reverse_slices(out, count, grid().slice_size());
}

model::Grid PartSource::extended(int slices) const {
  model::Grid grid = volume_.grid();
  if (options_.platform == "top") grid.origin_mm[2] -= (slices - grid.nz) * grid.voxel_mm;
  grid.nz = slices;
  return grid;
}

void PartSource::write(io::SparseVolume& volume, int first, int count, std::vector<float>& slices) const {
  if (options_.platform == "bottom") return volume.write_slices(first, count, slices.data());
  reverse_slices(slices.data(), count, grid().slice_size());
  volume.write_slices(volume.grid().nz - first - count, count, slices.data());
}

resin::PartColumns pack(const PartSource& part, resin::Exposure exposure) {
  const model::Grid& grid = part.grid();
  resin::PartColumns columns(grid.nx, grid.ny, grid.nz, exposure);
  std::vector<float> slab(grid.slice_size() * static_cast<std::size_t>(std::min(batch, grid.nz)));
  Progress progress("reading", grid.nz);
  for (int k = 0; k < grid.nz; k += batch) {
    const int count = std::min(batch, grid.nz - k);
    part.read(k, count, slab.data());
    columns.append(count, slab.data(), static_cast<float>(part.threshold()));
    progress.tick(count);
  }
  return columns;
}

}  // namespace vam::curethrough
