// The plain form of vam-sdf: print against design.
#include "metrology/compare/deviation.hpp"

#include <algorithm>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "base/json.hpp"
#include "base/log.hpp"
#include "base/text.hpp"
#include "io/image/image_file.hpp"
#include "io/mesh/file.hpp"
#include "io/settings/report.hpp"
#include "io/settings/resin_record.hpp"
#include "io/stream/stream.hpp"
#include "model/conditions.hpp"
#include "plot/plot.hpp"
#include "plot/save.hpp"
#include "solid/mesh/align.hpp"
#include "vam-sdf/options.hpp"

namespace vam::sdf_tool {

namespace {

// A part of a print must not be measured at a place where it only might be.
void require_unique(const Options& options, const solid::Alignment& found) {
  if (found.rival) {
    throw Error{Fault::data, options.print + ": is a part of the design and fits in two places, " +
                                 format_number(found.rival->apart_mm, 3) + " mm apart, with " +
                                 format_number(100 * found.rival->best_match, 3) + " and " +
                                 format_number(100 * found.rival->match, 3) +
                                 " % of its surface; move it near the right one and give --align icp"};
  }
  if (found.as_part) {
    note("the print covers only " + format_number(100 * found.overlap, 3) +
         " % of the design; aligned as a part of it");
  }
}

solid::Alignment align(const Options& options, const model::TriangleSoup& print, const model::TriangleSoup& design_mesh,
                       const solid::Surface& design) {
  solid::AlignOptions how;
  how.with_scale = options.scale;
  if (options.align == "full") {
    const solid::Alignment found = solid::align(print, design_mesh, design, how);
    require_unique(options, found);
    return found;
  }
  if (options.align == "icp") return solid::refine(print, design, how);
  solid::Alignment as_it_is;
  as_it_is.converged = true;
  return as_it_is;
}

double figure(const metrology::Comparison& found, const std::string& name, double tolerance_mm = 0) {
  const auto& d = found.print_to_design;
  if (name == "rms") return d.rms_mm;
  if (name == "mean") return d.mean_mm;
  if (name == "sigma") return d.sigma_mm;
  if (name == "mad") return d.mad_mm;
  if (name == "max") return d.max_abs_mm;
  if (name == "trimmed") return d.trimmed_mm;
  if (name == "within") return metrology::within_percent(found.samples_mm, tolerance_mm);
  if (name == "hausdorff") return found.hausdorff_mm;
  return 100 * d.rms_mm / found.largest_dimension_mm;  // rms_percent
}

void write_coloured(const std::string& path, const model::TriangleSoup& print, const solid::Surface& design,
                    double limit_mm, const std::string& history) {
  model::VertexData vertices;
  vertices.quality = design.signed_distances(print.points);
  for (const float distance : vertices.quality) {
    vertices.colours.push_back(metrology::blue_white_red(static_cast<double>(distance), limit_mm));
  }
  io::write_ply(path, print, vertices,
                {history, "distance in mm, positive outside the design; colours -" + format_number(limit_mm, 4) +
                              " (blue) to +" + format_number(limit_mm, 4) + " mm (red)"});
}

void write_histogram(const Options& options, const metrology::Comparison& found, double limit_mm) {
  plot::HistogramBuilder builder(-limit_mm, limit_mm, options.bins);
  for (const float distance : found.samples_mm) builder.add(static_cast<double>(distance));
  const plot::Histogram histogram = builder.done();
  const std::string& path = options.histogram;
  if (plot::is_figure(path)) {
    plot::Plot plot;
    plot.title = "Deviation of the print, RMS " + format_number(found.print_to_design.rms_mm, 3) + " mm";
    plot.x = {"distance to the design (mm), positive outside", -limit_mm, limit_mm};
    plot.y.label = "share of the area (%)";
    plot.series.push_back({"", histogram.edges, histogram.percent, plot::paint::blue, plot::SeriesStyle::bars});
    plot.markers.push_back({0, "design", plot::paint::grey});
    return plot::save(path, plot::draw(plot));
  }
  std::string text = "from_mm,to_mm,area_percent\n";
  for (std::size_t i = 0; i < histogram.percent.size(); ++i) {
    text += format_number(histogram.edges[i]) + "," + format_number(histogram.edges[i + 1]) + "," +
            format_number(histogram.percent[i]) + "\n";
  }
  io::write_text(path, text);
}

void note_figures(const metrology::Comparison& found) {
  for (const char* name : {"rms", "trimmed", "mean", "sigma", "mad", "max", "hausdorff"}) {
    note(std::string(name) + " " + format_number(figure(found, name), 4) + " mm, " +
         format_number(100 * figure(found, name) / found.largest_dimension_mm, 3) + " % of the size");
  }
}

Json facts(const Options& options, const solid::Alignment& alignment) {
  return {{"method", options.align},
          {"scale", alignment.transform.scale},
          {"shrinkage_percent", 100 * (1 - 1 / alignment.transform.scale)},
          {"overlap", options.align == "full" ? Json(alignment.overlap) : Json()},
          {"matrix", alignment.transform.matrix()}};
}

}  // namespace

void deviation(const cli::App& app, const Options& options) {
  std::vector<model::Condition> conditions;
  if (!options.require.empty())
    conditions = model::parse_conditions(
        options.require, {"rms", "trimmed", "mean", "sigma", "mad", "max", "hausdorff", "within", "rms_percent"});
  const bool asks_within =
      std::any_of(conditions.begin(), conditions.end(), [](const auto& c) { return c.name == "within"; });
  if (asks_within && !options.tolerance_mm) {
    throw Error{Fault::usage, "--require within: give the tolerance by --tolerance"};
  }
  if (options.scale && !options.volume.empty()) {
    throw Error{Fault::usage, "--fit-scale: the shrinkage would be missing in --volume; omit one of them"};
  }
  if (options.isovalue && !options.resin_record.empty())
    throw Error{Fault::usage, "--isovalue, --resin: both determine the isovalue of the print; give only one"};
  const std::optional<double> isovalue =
      options.resin_record.empty() ? options.isovalue : io::gelation_isovalue(options.resin_record);
  const model::TriangleSoup design_mesh = read_surface(options.design, options.design_isovalue);
  std::optional<metrology::BodyCount> bodies;
  model::TriangleSoup print = read_print(options.print, isovalue, options.pieces_mm3, bodies);
  if (bodies && bodies->dropped > 0) {
    note("dropped " + std::to_string(bodies->dropped) + " bodies of " + format_number(bodies->dropped_mm3, 3) +
         " mm3, the largest " + format_number(bodies->largest_dropped_mm3, 3) + " mm3");
  }

  const solid::Surface design(design_mesh);
  const solid::Alignment alignment = align(options, print, design_mesh, design);
  if (!alignment.converged)
    warn("alignment: not converged after " + std::to_string(alignment.iterations) + " iterations");
  for (auto& point : print.points) point = alignment.transform(point);
  const metrology::Comparison found = metrology::compare(print, design_mesh, design, options.samples);

  const auto& ends = found.print_to_design.percentiles_mm;
  const double limit_mm =
      options.limit_mm.value_or(std::max({std::abs(ends.front().second), std::abs(ends.back().second), 1e-6}));
  if (!options.output.empty()) write_coloured(options.output, print, design, limit_mm, app.history());
  if (!options.histogram.empty()) write_histogram(options, found, limit_mm);
  if (!options.volume.empty()) {
    write_deviation_volume(app, options, print, design_mesh, found.print_to_design.rms_mm);
  }
  Json figures = metrology::to_json(found);
  figures["alignment"] = facts(options, alignment);
  if (options.tolerance_mm) {
    figures["tolerance_mm"] = *options.tolerance_mm;
    figures["within_percent"] = metrology::within_percent(found.samples_mm, *options.tolerance_mm);
  }
  if (bodies) figures["bodies"] = metrology::to_json(*bodies);
  io::write_report(options.report, "vam-sdf/1", figures);
  note_figures(found);
  const auto failed = model::unmet(
      conditions, [&](const std::string& name) { return figure(found, name, options.tolerance_mm.value_or(0)); });
  if (!failed.empty()) throw Error{Fault::judged, join(failed, "; ")};
}

}  // namespace vam::sdf_tool
