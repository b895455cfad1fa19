// SPDX-License-Identifier: GPL-3.0-or-later
// The plain form of vam-sdf: print against design.
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "base/log/log.hpp"
#include "base/text/json.hpp"
#include "base/text/text.hpp"
#include "io/image/image_file.hpp"
#include "io/mesh/file.hpp"
#include "io/settings/sealed_text.hpp"
#include "io/stream/file_type.hpp"
#include "io/stream/stream.hpp"
#include "metrology/compare/inspection.hpp"
#include "metrology/compare/uncertainty.hpp"
#include "model/conditions.hpp"
#include "plot/curves.hpp"
#include "plot/save.hpp"
#include "session/surface.hpp"
#include "solid/mesh/align.hpp"
#include "solid/mesh/repair.hpp"
#include "solid/mesh/signed_distance.hpp"
#include "vam-sdf/steps.hpp"

namespace vam::sdf_tool {

namespace {

double number_at(const Json& json, const std::string& name) {
  return json.at(Json::json_pointer(place_of(name))).get<double>();
}

// A condition with a guard band holds for all values that the uncertainty leaves (ISO 14253-1).
std::vector<std::string> failures(const Options& options, const std::vector<model::Condition>& conditions,
                                  const Json& figures, const Json& uncertainty) {
  std::vector<std::string> failed;
  for (const model::Condition& condition : conditions) {
    const double band = options.guard_band ? number_at(uncertainty, condition.name) : 0.0;
    const double value = number_at(figures, condition.name) + (condition.relation.starts_with('>') ? -band : band);
    for (const std::string& line : model::unmet({condition}, [&](const std::string&) { return value; })) {
      failed.push_back(line + (options.guard_band ? " (with its uncertainty of " + format_number(band, 3) + ")" : ""));
    }
  }
  return failed;
}

void write_coloured(const std::string& path, const model::TriangleSoup& print, const solid::Surface& design,
                    double limit_mm, const metrology::SurfaceErrors& errors, const std::string& history) {
  model::VertexData vertices;
  vertices.quality = design.signed_distances(print.points);
  if (errors.source != "roughness") vertices.uncertainty = errors.vertex_mm;
  for (const float distance : vertices.quality) {
    vertices.colours.push_back(metrology::blue_white_red(static_cast<double>(distance), limit_mm));
  }
  io::write_ply(path, print, vertices,
                {history, "distance in mm, positive outside the design; colours -" + format_number(limit_mm, 4) +
                              " (blue) to +" + format_number(limit_mm, 4) + " mm (red)"});
}

plot::Histogram histogram_of(const Options& options, const metrology::Distances& found, double limit_mm) {
  plot::HistogramBuilder builder(-limit_mm, limit_mm, options.bins);
  for (const float distance : found.print_mm) builder.add(static_cast<double>(distance));
  return builder.done();
}

void write_histogram(const std::string& path, const plot::Histogram& histogram, double rms_mm) {
  if (plot::is_figure(path)) return plot::save(path, plot::draw(plot::deviation_histogram(histogram, rms_mm)));
  std::string text = "from_mm,to_mm,area_percent\n";
  for (std::size_t i = 0; i < histogram.percent.size(); ++i) {
    text += format_number(histogram.edges[i]) + "," + format_number(histogram.edges[i + 1]) + "," +
            format_number(histogram.percent[i]) + "\n";
  }
  io::write_text(path, text);
}

void note_figures(const Json& figures, const Json& uncertainty, const std::vector<metrology::Region>& regions) {
  for (const std::string& name : figure_names(regions)) {
    if (!figures.contains(Json::json_pointer(place_of(name)))) continue;
    const std::string place = place_of(name);
    const std::string unit = place.ends_with("_mm") ? " mm" : place.ends_with("_deg") ? " deg" : " %";
    note(name + " " + format_number(number_at(figures, name), 4) + " +- " +
         format_number(number_at(uncertainty, name), 2) + unit);
  }
}

Json facts(const Options& options, const solid::Alignment& alignment) {
  return {{"method", options.align},
          {"scale", alignment.transform.scale},
          {"shrinkage_percent", 100 * (1 - 1 / alignment.transform.scale)},
          {"datum", options.datum},
          {"overlap", options.align == "full" ? Json(alignment.overlap) : Json()},
          {"matrix", alignment.transform.matrix()}};
}

// Distances are the same with them, but not their shares by area.
void warn_of_doubles(const model::TriangleSoup& mesh, const std::string& file) {
  const long doubled = solid::duplicate_triangles(mesh);
  if (doubled == 0) return;
  warn(io::input_name(file) + ": holds " + std::to_string(doubled) +
       " duplicate triangles; a body may be there twice, and counts twice in areas and percentiles");
}

// Only the figure `within` needs one.
bool has_tolerance(const std::string& figure, const Toleranced& asked) {
  if (figure == "within") return asked.tolerance_mm.has_value();
  return std::all_of(asked.regions.begin(), asked.regions.end(), [&](const metrology::Region& region) {
    return region.tolerance_mm || region.name + ".within" != figure;
  });
}

std::vector<model::Condition> conditions_of(const Options& options, const Toleranced& asked) {
  if (options.require.empty()) return {};
  auto conditions = model::parse_conditions(options.require, figure_names(asked.regions));
  for (const model::Condition& condition : conditions) {
    if (has_tolerance(condition.name, asked)) continue;
    throw Error{Fault::usage, "--require " + condition.name + ": give the tolerance by --tolerance"};
  }
  return conditions;
}

metrology::SurfaceErrors errors_of(const Options& options, const PrintSurface& print, const solid::Surface& design,
                                   double largest_dimension_mm) {
  metrology::SurfaceErrors errors;
  if (print.uncertainty_mm.empty()) {
    errors = metrology::roughness(print.mesh, design, largest_dimension_mm);
  } else {
    errors = {print.bodies ? "volume" : "mesh", print.uncertainty_mm, metrology::mean_edge_mm(print.mesh)};
  }
  const bool is_mesh = !print.bodies && print.uncertainty_mm.empty();  // its edges say nothing of voxels
  if (!is_mesh) {
    errors.resolution_mm = metrology::resolved_cells * errors.cell_mm;
    errors.extreme_mm = metrology::extreme_cells * errors.cell_mm;
  }
  errors.common_mm = print.mm_per_isovalue * options.isovalue_uncertainty;
  errors.scale = 0.01 * options.scale_uncertainty_percent;
  return errors;
}

}  // namespace

void deviation(const cli::App& app, const Options& options) {
  constexpr std::size_t datum_faces = 3;
  if (!options.datum.empty() && options.datum.size() != datum_faces) {
    throw Error{Fault::usage, "--datum: name three regions, primary first"};
  }
  const Toleranced asked = read_regions(options);
  const std::vector<metrology::Region>& regions = asked.regions;
  const std::vector<model::Condition> conditions = conditions_of(options, asked);
  const std::optional<double> isovalue =
      options.resin_record.empty() ? options.isovalue : io::gelation_isovalue(options.resin_record);
  if (!io::is_volume(options.design)) app.require_for("mesh designs", options.design);
  const model::TriangleSoup design_mesh = session::read_surface(options.design, options.design_isovalue);
  PrintSurface surface = read_print(app, options, isovalue);
  model::TriangleSoup& print = surface.mesh;
  const auto& bodies = surface.bodies;
  if (bodies && bodies->dropped > 0) {
    note("dropped " + std::to_string(bodies->dropped) + " bodies of " + format_number(bodies->dropped_mm3, 3) +
         " mm3, the largest " + format_number(bodies->largest_dropped_mm3, 3) + " mm3");
  }

  warn_of_doubles(design_mesh, options.design);
  if (!bodies) warn_of_doubles(print, options.print);

  const solid::Surface design(design_mesh);
  const solid::Alignment alignment = align_print(options, regions, design_mesh, design, print);
  metrology::Inspection found = metrology::inspect(print, design_mesh, design, options.samples, regions);
  found.tolerance_mm = asked.tolerance_mm;
  found.pose = {options.align != "none", options.scale, 100 * (1 - 1 / alignment.transform.scale), options.datum};
  const metrology::SurfaceErrors errors = errors_of(options, surface, design, found.distances.largest_dimension_mm);
  if (errors.resolution_mm == 0) {
    note(
        io::input_name(options.print) +
        ": a mesh does not tell the resolution it was measured with, which the uncertainties lack; give the volume and "
        "--uncertainty");
  }
  Json figures = metrology::figures_json(found);
  const Json uncertainty = metrology::expanded_uncertainty(found, print, errors);

  const Json& ends = figures["print_to_design"];
  const double limit_mm = options.limit_mm.value_or(
      std::max({std::abs(ends["p1_mm"].get<double>()), std::abs(ends["p99_mm"].get<double>()), 1e-6}));
  const double rms_mm = ends["rms_mm"];
  const plot::Histogram histogram = histogram_of(options, found.distances, limit_mm);
  if (!options.output.empty()) write_coloured(options.output, print, design, limit_mm, errors, app.history());
  if (!options.histogram.empty()) write_histogram(options.histogram, histogram, rms_mm);
  if (!options.volume.empty()) write_deviation_volume(app, options, print, design_mesh, rms_mm);
  const auto failed = failures(options, conditions, figures, uncertainty);
  figures["alignment"] = facts(options, alignment);
  if (asked.tolerance_mm) figures["tolerance_mm"] = *asked.tolerance_mm;
  for (const metrology::Region& region : regions) {
    if (region.tolerance_mm) figures["regions"][region.name]["tolerance_mm"] = *region.tolerance_mm;
  }
  if (bodies) figures["bodies"] = metrology::to_json(*bodies);
  figures["expanded_uncertainty"] = uncertainty;
  figures["uncertainty_budget"] = metrology::to_json(errors);
  figures["histogram"] = {{"edges_mm", histogram.edges}, {"area_percent", histogram.percent}};
  figures["require"] = {{"conditions", options.require}, {"guard_band", options.guard_band}, {"unmet", failed}};
  io::write_report(options.report, "vam-sdf", figures);
  note_figures(figures, uncertainty, regions);
  if (!failed.empty()) throw Error{Fault::judged, join(failed, "; ")};
}

}  // namespace vam::sdf_tool
