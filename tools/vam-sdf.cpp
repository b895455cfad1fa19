// vam-sdf: how far a print is from its design.
#include <algorithm>
#include <cstdio>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "base/log.hpp"
#include "base/text.hpp"
#include "cli/app.hpp"
#include "cli/common.hpp"
#include "io/mesh_file.hpp"
#include "io/picture.hpp"
#include "io/plot.hpp"
#include "io/report.hpp"
#include "io/stream.hpp"
#include "io/vdb.hpp"
#include "metrology/deviation.hpp"
#include "model/conditions.hpp"
#include "solid/align.hpp"
#include "solid/isosurface.hpp"

namespace {

using namespace vam;

struct Options {
  std::string print = "-";
  std::string reference;
  std::string output;
  std::string align = "full";
  bool scale = false;
  std::optional<double> level;
  double reference_level = 0.5;
  int samples = 200000;
  std::string histogram;
  int bins = 101;
  std::optional<double> limit_mm;
  std::string require;
  std::string report;
};

cli::Manual manual() {
  return {
      "vam-sdf",
      "measure the deviation of a print from its design",
      {"Reads the print (a mesh, or a volume whose surface is taken at --level) and the reference (a mesh, or a target "
       "volume), lays one onto the other, and measures signed distances: positive where the print stands outside the "
       "reference, as MeshLab, CloudCompare and Open3D have it. Statistics are of points spread evenly over the area, "
       "in both directions: from the print to the reference, and from the reference to the print, where alone missing "
       "pieces show.",
       "A volume is read in its own frame; the stretch in z that vam-slice applied is undone, so that a simulated dose "
       "can be held against the mesh it came from.",
       "--align full needs no start: centroids and principal axes give it, every symmetric variant is tried, and "
       "point-to-plane ICP ends it. --align icp trusts the pose of the files; --align none keeps it. With --scale the "
       "uniform scale is fitted too and reported as shrinkage.",
       "A table goes to standard error when that is a terminal, the figures as JSON to --report, the print with "
       "distances and blue-white-red colours to -o. With --require the exit status is 1 unless every condition holds."},
      {{"Two boxes, one a little larger:",
        "vam-slice --shape box:x=6,y=6,z=6 --stretch-z 1 -o design.vdb\n"
        "vam-slice --shape box:x=6.2,y=6.2,z=6.2 --stretch-z 1 -o print.vdb\n"
        "vam-sdf print.vdb design.vdb --level 0.5 -o deviation.ply --report deviation.json"},
       {"A verdict for a script:",
        "vam-sdf print.vdb design.vdb --level 0.5 --require 'rms<=0.2' --histogram sdf.csv"}},
      {"Signs come from the generalised winding number, so that a reference with holes works. Distances are exact to "
       "the triangles; the fine percentiles depend on --samples.",
       "Sources: Orth et al., On-the-fly 3D metrology of volumetric additive manufacturing, 2022, section 3 and table "
       "S1; Chen & Medioni, point-to-plane registration, 1992; Barill et al., Fast winding numbers, 2018."},
      {"vam-ost", "vam-dose", "vam-score", "vam-slice"}};
}

void declare(cli::App& app, Options& options) {
  app.positional("PRINT", options.print, "Mesh (STL, OBJ, PLY, OFF, 3MF) or volume (.vdb).");
  app.positional("REFERENCE", options.reference, "Mesh or volume of the design.");
  app.option("-o,--output", "FILE.ply", options.output,
             "The aligned print with distances and colours at its vertices.");
  app.option("--level", "VALUE", options.level, cli::any, "Surface of a print volume: the threshold in its units.");
  app.option("--reference-level", "VALUE", options.reference_level, cli::any, "Surface of a reference volume.");
  app.group("Alignment");
  app.choice("--align", options.align, {"none", "icp", "full"}, "How the print is laid onto the reference.");
  app.flag("--scale", options.scale, "Fit a uniform scale too.");
  app.group("Figures");
  app.option("--samples", "N", options.samples, {1000, 1e8}, "Points spread over each surface.");
  app.option("--histogram", "FILE", options.histogram,
             "Share of the area per distance: .png draws it, any other name is CSV.");
  app.option("--bins", "N", options.bins, {2, 10000}, "Bins of the histogram.");
  app.option("--limit", "MM", options.limit_mm, cli::positive,
             "End of the histogram and of the colours; the 99th percentile without it.");
  app.option("--require", "CONDITIONS", options.require,
             "Conditions on rms, mean, sigma, mad, max, hausdorff (mm) and rms_percent, e.g. 'rms<=0.2,hausdorff<1'.");
  cli::add_report(app, options.report);
  cli::add_threads(app);
}

bool is_volume(const std::string& path) { return path.size() > 4 && path.substr(path.size() - 4) == ".vdb"; }

model::TriangleSoup read_surface(const std::string& path, std::optional<double> level) {
  if (!is_volume(path)) return io::read_mesh(path);
  if (!level) throw Error{Fault::usage, path + ": is a volume; give the surface's value with --level"};
  const io::SparseVolume volume = io::read_volume(path, "");
  model::TriangleSoup mesh = solid::isosurface(
      volume.grid(), [&](int k, int count, float* out) { volume.read_slices(k, count, out); }, *level);
  if (mesh.triangles.empty()) {
    throw Error{Fault::data, path + ": no surface, the volume does not cross " + format_number(*level)};
  }
  const auto stretch = volume.metadata.find("vam:stretch_z");
  const double factor = stretch == volume.metadata.end() ? 1.0 : parse_number(stretch->second).value_or(1.0);
  for (auto& point : mesh.points) point[2] /= factor;
  return mesh;
}

solid::Alignment align(const Options& options, const model::TriangleSoup& print,
                       const model::TriangleSoup& reference_mesh, const solid::Surface& reference) {
  solid::AlignOptions how;
  how.with_scale = options.scale;
  if (options.align == "full") return solid::align(print, reference_mesh, reference, how);
  if (options.align == "icp") return solid::refine(print, reference, how);
  solid::Alignment as_it_is;
  as_it_is.converged = true;
  return as_it_is;
}

double figure(const metrology::Comparison& found, const std::string& name) {
  const auto& d = found.print_to_reference;
  if (name == "rms") return d.rms_mm;
  if (name == "mean") return d.mean_mm;
  if (name == "sigma") return d.sigma_mm;
  if (name == "mad") return d.mad_mm;
  if (name == "max") return d.max_abs_mm;
  if (name == "hausdorff") return found.hausdorff_mm;
  return 100 * d.rms_mm / found.largest_dimension_mm;  // rms_percent
}

void write_coloured(const std::string& path, const model::TriangleSoup& print, const solid::Surface& reference,
                    double limit_mm, const std::string& history) {
  model::VertexData vertices;
  vertices.quality = reference.signed_distances(print.points);
  for (const float distance : vertices.quality) {
    vertices.colours.push_back(metrology::blue_white_red(static_cast<double>(distance), limit_mm));
  }
  io::write_ply(path, print, vertices,
                {history, "distance in mm, positive outside the reference; colours -" + format_number(limit_mm, 4) +
                              " (blue) to +" + format_number(limit_mm, 4) + " mm (red)"});
}

void write_histogram(const Options& options, const metrology::Comparison& found, double limit_mm) {
  io::HistogramBuilder builder(-limit_mm, limit_mm, options.bins);
  for (const float distance : found.samples_mm) builder.add(static_cast<double>(distance));
  const io::Histogram histogram = builder.done();
  const std::string& path = options.histogram;
  if (path.size() > 4 && path.substr(path.size() - 4) == ".png") {
    io::Plot plot;
    plot.title = "Deviation of the print, RMS " + format_number(found.print_to_reference.rms_mm, 3) + " mm";
    plot.x = {"distance to the reference / mm (positive: outside)", -limit_mm, limit_mm};
    plot.y.label = "share of the area / %";
    plot.series.push_back({"", histogram.edges, histogram.percent, io::paint::blue, io::SeriesStyle::bars});
    plot.markers.push_back({0, "reference", io::paint::grey});
    return io::write_png(path, io::draw(plot));
  }
  std::string text = "from_mm,to_mm,area_percent\n";
  for (std::size_t i = 0; i < histogram.percent.size(); ++i) {
    text += format_number(histogram.edges[i]) + "," + format_number(histogram.edges[i + 1]) + "," +
            format_number(histogram.percent[i]) + "\n";
  }
  io::write_text(path, text);
}

void run(const cli::App& app, const Options& options) {
  if (options.reference.empty()) throw Error{Fault::usage, "REFERENCE: give the design to compare with"};
  std::vector<model::Condition> conditions;
  if (!options.require.empty())
    conditions =
        model::parse_conditions(options.require, {"rms", "mean", "sigma", "mad", "max", "hausdorff", "rms_percent"});
  for (const auto& input : {options.print, options.reference}) {
    if (!options.output.empty()) io::refuse_same_file(input, options.output);
  }
  const model::TriangleSoup reference_mesh = read_surface(options.reference, options.reference_level);
  model::TriangleSoup print = read_surface(options.print, options.level);

  const solid::Surface reference(reference_mesh);
  const solid::Alignment alignment = align(options, print, reference_mesh, reference);
  if (!alignment.converged)
    warn("alignment: still moving after " + std::to_string(alignment.iterations) + " iterations");
  for (auto& point : print.points) point = alignment.transform(point);
  const metrology::Comparison found = metrology::compare(print, reference_mesh, reference, options.samples);

  const auto& ends = found.print_to_reference.percentiles_mm;
  const double limit_mm =
      options.limit_mm.value_or(std::max({std::abs(ends.front().second), std::abs(ends.back().second), 1e-6}));
  if (!options.output.empty()) write_coloured(options.output, print, reference, limit_mm, app.history());
  if (!options.histogram.empty()) write_histogram(options, found, limit_mm);
  Json figures = metrology::to_json(found);
  figures["alignment"] = {{"method", options.align},
                          {"scale", alignment.transform.scale},
                          {"shrinkage_percent", 100 * (1 - 1 / alignment.transform.scale)},
                          {"matrix", alignment.transform.matrix()}};
  io::write_report(options.report, "vam-sdf/1", figures);
  for (const char* name : {"rms", "mean", "sigma", "mad", "max", "hausdorff"}) {
    note(std::string(name) + " " + format_number(figure(found, name), 4) + " mm, " +
         format_number(100 * figure(found, name) / found.largest_dimension_mm, 3) + " % of the size");
  }
  const auto failed = model::unmet(conditions, [&](const std::string& name) { return figure(found, name); });
  if (!failed.empty()) throw Error{Fault::judged, join(failed, "; ")};
}

}  // namespace

int main(int argc, char** argv) {
  cli::App app(manual());
  Options options;
  declare(app, options);
  return app.run(argc, argv, [&] { run(app, options); });
}
