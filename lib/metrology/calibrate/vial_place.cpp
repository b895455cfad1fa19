// SPDX-License-Identifier: GPL-3.0-or-later
#include "metrology/calibrate/vial_place.hpp"

#include <cmath>
#include <span>
#include <string>

#include "base/constants.hpp"
#include "base/error.hpp"
#include "base/text/text.hpp"
#include "metrology/calibrate/private/edges.hpp"
#include "optics/chief_ray.hpp"
#include "optics/writable_radius.hpp"

namespace vam::metrology {

namespace {

constexpr double nearest_deg = 60, furthest_deg = 91;  // of the camera from the projector: beyond, an edge may be lost

void require_camera_beside(double azimuth_deg) {
  const double from_light_deg = std::acos(std::cos(azimuth_deg * rad_per_deg)) * deg_per_rad;
  if (from_light_deg >= nearest_deg - 1e-9 && from_light_deg <= furthest_deg + 1e-9) return;
  throw Error{Fault::data, "sweep: the camera is at " + format_number(azimuth_deg) +
                               " degrees to the beam; edges are detected from " + format_number(nearest_deg) + " to " +
                               format_number(furthest_deg) + " on either side (camera.azimuth_deg)"};
}

/// Outer radius in mm of the vial whose outermost lit column is R_e = edge_px columns from the axis: in air
/// R = R_e / sqrt(1 + (R_e / D_p)^2), which is optics::impact_mm() and has the sign of the square right [RAY21 eq 9;
/// physics §10, §12]. If the resin, not the glass, ends the light, the glass is a wall further out.
double vial_radius_mm(const model::Printer& printer, double edge_px) {
  const optics::View view = optics::projector_view(printer);
  const double impact = optics::impact_mm(view, edge_px * printer.projector.pixel_mm);
  if (optics::grazing_impact_mm(view) >= view.shells.front().radius_mm * (1 - 1e-12)) return impact;
  return impact * optics::resin_radius_mm(view) / optics::grazing_impact_mm(view) + printer.vial.wall_mm;
}

/// A band with light between two dark sides.
struct LitBand {
  std::size_t band;
  SteepestEdges first;  // where its edges about are
};

std::vector<LitBand> lit_bands(const SweepScan& scan) {
  std::vector<LitBand> lit;
  for (std::size_t b = 0; b < scan.signal.size() && scan.column.size() >= least_readings; ++b) {
    const SteepestEdges edges = steepest(scan.column, scan.signal[b]);
    if (edges.clear) lit.push_back({b, edges});
  }
  if (!lit.empty()) return lit;
  throw Error{Fault::data, "sweep: at no height is there light between two dark sides (line positions: " +
                               std::to_string(scan.column.size()) +
                               "); sweep beyond both edges of the vial, and expose the camera longer"};
}

/// Centre of each lit band, and the means of what they all have.
void fit_bands(const SweepScan& scan, const EdgeShapes& shapes, std::span<const LitBand> lit, VialEdges& out) {
  std::vector<stats::Measured> edges;
  std::vector<stats::Measured> blurs;
  out.centre_column.resize(scan.signal.size());
  for (const auto& [b, first] : lit) {
    const BandEdges band = fit_band(scan, scan.signal[b], shapes, first);
    out.centre_column[b] = band.centre;
    edges.push_back(band.edge);
    blurs.push_back(band.blur);
  }
  out.edge_px = stats::weighted_mean(edges);
  out.blur_px = stats::weighted_mean(blurs);
}

/// The line through the centres.
void fit_axis(const SweepScan& scan, double pixel_mm, std::span<const LitBand> lit, VialEdges& out) {
  if (lit.size() == 1) {
    out.axis_column = out.centre_column[lit.front().band];
    return;
  }
  std::vector<double> heights;
  std::vector<stats::Measured> centres;
  for (const LitBand& one : lit) {
    heights.push_back(scan.height_mm[one.band]);
    centres.push_back(out.centre_column[one.band]);
  }
  const stats::WeightedLine axis = stats::weighted_line(heights, centres);
  out.axis_column = axis.at_zero;
  out.tilt_deg = stats::lean_deg(axis.slope, pixel_mm);
}

}  // namespace

VialEdges find_edges(const SweepScan& scan, const model::Printer& printer) {
  require_camera_beside(printer.camera.azimuth_deg);
  const std::vector<LitBand> lit = lit_bands(scan);
  // How the camera sees an edge depends a little on the radius: the one that the steepest changes give, then the
  // fitted.
  model::Printer about = printer;
  about.vial.radius_mm = vial_radius_mm(printer, 0.5 * (lit.front().first.fall - lit.front().first.rise));
  VialEdges out;
  for (int pass = 0; pass < 2; ++pass) {
    fit_bands(scan, edge_shapes(about), lit, out);
    about.vial.radius_mm = vial_radius_mm(printer, out.edge_px.value);
  }
  fit_axis(scan, printer.projector.pixel_mm, lit, out);
  const double edge_px = out.edge_px.value;
  const double slope = vial_radius_mm(printer, edge_px + 1) - vial_radius_mm(printer, edge_px);
  out.radius_mm = {vial_radius_mm(printer, edge_px), slope * out.edge_px.sigma, out.edge_px.n};
  return out;
}

}  // namespace vam::metrology
