// SPDX-License-Identifier: GPL-3.0-or-later
#include "vam-curethrough/print.hpp"

#include <numbers>

#include "base/log/log.hpp"
#include "base/text/json.hpp"
#include "base/text/text.hpp"
#include "session/printer.hpp"

namespace vam::curethrough {

void add_print(cli::App& app, PrintOptions& options, const std::vector<std::string>& not_for) {
  app.group("Print", {}, not_for);
  app.option("--print-speed", "MM_H", options.speed_mm_h, cli::rate, "Speed of the platform.");
  app.option("--absorbance-height", "UM", options.absorbance_height_um, cli::positive,
             "Depth in which the intensity falls to a tenth (base 10).");
  app.default_is("from resin.absorption_per_mm, else 2000");
  app.option("--full-cure-dose", "MJ_CM3", options.full_cure_dose_mj_cm3, cli::positive, "Dose D_f of full strength.");
  app.default_is("5 x resin.critical_dose_mj_cm3, else 576");
  app.group("Print");
  app.choice("--exposure-mode", options.exposure, {"continuous", "layered"},
             "Motion of the platform: continuous, or at rest during each layer (exposed for slice height / speed).");
  cli::add_printer(app, options.printer);
}

resin::ExposureMode exposure_of(const PrintOptions& options) {
  return options.exposure == "layered" ? resin::ExposureMode::layered : resin::ExposureMode::continuous;
}

PrintSettings resolve(const PrintOptions& options, double slice_um) {
  PrintSettings print{session::load_printer(options.printer), {}, {}, resin::Response()};
  const model::Projector& projector = print.printer.projector;
  resin::Process& process = print.process;
  process.exposure = exposure_of(options);
  process.slice_um = slice_um;
  process.speed_mm_h = options.speed_mm_h;
  const model::Resin& resin = print.printer.resin;
  if (resin.absorption_per_mm > 0) process.absorbance_height_um = std::numbers::ln10 / resin.absorption_per_mm * 1e3;
  if (options.absorbance_height_um) process.absorbance_height_um = *options.absorbance_height_um;
  if (options.full_cure_dose_mj_cm3) {
    process.full_cure_dose_mj_cm3 = *options.full_cure_dose_mj_cm3;
  } else if (resin.critical_dose_mj_cm3) {
    process.full_cure_dose_mj_cm3 = resin::full_cure_factor * *resin.critical_dose_mj_cm3;
    note("full-cure dose " + format_number(process.full_cure_dose_mj_cm3, 4) +
         " mJ/cm3, 5 times resin.critical_dose_mj_cm3");
  }
  process.max_intensity_mw_cm2 = projector.max_intensity_mw_cm2;
  process.min_intensity_mw_cm2 = projector.min_intensity_mw_cm2;
  print.response = session::response_of(projector);
  if (!projector.response.empty()) {
    process.min_intensity_mw_cm2 = print.response.intensity(0) * process.max_intensity_mw_cm2;
  }
  print.limits = resin::limits_of(process);
  return print;
}

namespace {

std::string mode_name(const resin::Process& process) {
  return process.exposure == resin::ExposureMode::layered ? "layered" : "continuous";
}

}  // namespace

double frames_per_s(const resin::Process& process) { return process.speed_mm_h / 3600 / (process.slice_um * 1e-3); }

Json to_json(const resin::Process& process) {
  const resin::CureLimits limits = resin::limits_of(process);
  return {{"exposure", mode_name(process)},
          {"slice_um", process.slice_um},
          {"absorbance_height_um", process.absorbance_height_um},
          {"full_cure_dose_mj_cm3", process.full_cure_dose_mj_cm3},
          {"speed_mm_h", process.speed_mm_h},
          {"fps", frames_per_s(process)},
          {"min_intensity_mw_cm2", process.min_intensity_mw_cm2},
          {"max_intensity_mw_cm2", process.max_intensity_mw_cm2},
          {"full_cure_intensity_mw_cm2", resin::full_cure_intensity_mw_cm2(process)},
          {"phi_min", limits.phi_min},
          {"phi_max", limits.phi_max}};
}

std::map<std::string, std::string> attributes(const resin::Process& process) {
  return {{"vam:exposure", mode_name(process)},
          {"vam:slice_mm", format_number(process.slice_um * 1e-3, 9)},
          {"vam:speed_mm_h", format_number(process.speed_mm_h, 9)},
          {"vam:fps", format_number(frames_per_s(process), 9)}};
}

}  // namespace vam::curethrough
