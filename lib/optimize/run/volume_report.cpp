// SPDX-License-Identifier: GPL-3.0-or-later
#include <sstream>

#include "base/text/json.hpp"
#include "base/text/text.hpp"
#include "model/dose/figures.hpp"
#include "optimize/run/slice_figures.hpp"
#include "optimize/run/volume.hpp"

namespace vam::optimize {

Json report(const VolumeOutcome& outcome) {
  Json json;
  json["distinct_slices"] = outcome.jobs;
  json["iterations"] = outcome.iterations;
  json["stopped_by"] = reason_name(outcome.stop);
  for (const auto& name : model::figure_names()) json[name] = model::figure(outcome.metrics, name);
  json["efficiency"] = outcome.efficiency;
  json["peak_intensity"] = outcome.peak_intensity;
  if (outcome.max_intensity > 0) json["max_intensity"] = outcome.max_intensity;
  if (outcome.even_intensity > 0) json["even_intensity"] = outcome.even_intensity;
  if (outcome.least_ratio > 0) json["least_void_over_part"] = outcome.least_ratio;
  if (outcome.outside) append_json(json, *outcome.outside);
  if (outcome.certificate) {
    const double ratio = outcome.metrics.min_part > 0 ? outcome.metrics.max_void / outcome.metrics.min_part : 0;
    json["certificate"] = {{"void_over_part", ratio},
                           {"least_void_over_part", outcome.certificate->least},
                           {"unlimited_void_over_part", outcome.certificate->reached}};
  }
  json["dark_part_voxels"] = outcome.dark_part_voxels;
  return json;
}

std::string trace_csv(const std::vector<model::DoseMetrics>& trace) {
  std::ostringstream csv;
  csv << "iteration";
  for (const auto& name : SliceFigures::names()) csv << "," << name;
  csv << "\n";
  for (std::size_t i = 0; i < trace.size(); ++i) {
    csv << i;
    for (const auto& name : SliceFigures::names()) csv << "," << format_number(model::figure(trace[i], name));
    csv << "\n";
  }
  return csv.str();
}

}  // namespace vam::optimize
