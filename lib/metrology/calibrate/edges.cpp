#include "metrology/calibrate/edges.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <string>

#include "base/constants.hpp"
#include "base/error.hpp"
#include "base/stats/curve_fit.hpp"
#include "base/text.hpp"
#include "metrology/calibrate/private/sight_lines.hpp"
#include "optics/chief_ray.hpp"

namespace vam::metrology {

namespace {

constexpr double window = 0.25;                        // of R_e, to either side of an edge
constexpr double nearest_deg = 60, furthest_deg = 91;  // of the camera from the projector: beyond, an edge may be lost

// Impact parameter of the outermost ray that meets resin: n_0 b may not exceed n R on either side of any interface.
double grazing_mm(const optics::View& view) {
  double outside = view.bath_index;
  double smallest_mm = INFINITY;
  for (const auto& shell : view.shells) {
    smallest_mm = std::min(smallest_mm, shell.radius_mm * std::min(outside, shell.index) / view.bath_index);
    outside = shell.index;
  }
  return smallest_mm;
}

// The column whose ray has this impact parameter; impact_mm() rises with the column.
double column_of_impact_mm(const optics::View& view, double impact) {
  double low = 0;
  double high = 2 * impact;
  while (optics::impact_mm(view, high) < impact && high < 1e6 * impact) high *= 2;
  for (int step = 0; step < 60; ++step) {
    const double middle = 0.5 * (low + high);
    (optics::impact_mm(view, middle) < impact ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

// SightLines sees a sheet as a perfect camera would. Effects of lens and position change with the orientation of the
// sheet, that is with the angle delta of its ray, which near grazing varies with the square root of the depth below the
// edge, and with its position. Their share is therefore a polynomial in t, the angle from that at the edge plus the
// depth as a fraction of R_e.
constexpr std::size_t powers = 3;
using Terms = std::array<double, powers>;

// What is seen of the ray of column q * R_e times 1, t, t^2; 0 beyond the edge. As running integrals over q: a line
// that has a width is a difference of two integrals, exactly, however steep the edge.
class EdgeShape {
 public:
  // sign: -1 at the low edge.
  EdgeShape(const model::Printer& printer, const SightLines& side, double edge_mm, double sign) : integral_{Terms{}} {
    const optics::View view = optics::projector_view(printer);
    const double most_rad = std::abs(optics::chief_ray(view, edge_mm * (1 - 1e-9)).delta_rad);
    for (std::size_t i = 1; i <= cells; ++i) {
      const double q = 0.5 * (node(i - 1) + node(i));
      const auto ray = optics::chief_ray(view, sign * q * edge_mm);
      const double t = most_rad - std::abs(ray.delta_rad) + 1 - q;
      const double width = node(i) - node(i - 1);
      double cell = width * side.seen(ray);
      Terms sum = integral_.back();
      for (std::size_t k = 0; k < powers; ++k, cell *= t) sum[k] += cell;
      integral_.push_back(sum);
    }
  }
  /// Integrals from `low` to q; below `low` the curves go on level.
  [[nodiscard]] Terms integral(double q) const {
    if (q >= 1) return integral_.back();
    const double place = q <= low ? 0 : (1 - std::sqrt((1 - q) / (1 - low))) * static_cast<double>(cells);
    const auto cell = std::min(static_cast<std::size_t>(place), cells - 1);
    const double part = (q - node(cell)) / (node(cell + 1) - node(cell));  // linear in q between the nodes
    Terms out{};
    for (std::size_t k = 0; k < powers; ++k) {
      out[k] = integral_[cell][k] + part * (integral_[cell + 1][k] - integral_[cell][k]);
    }
    return out;
  }

 private:
  // Denser towards the edge.
  static double node(std::size_t i) {
    const double r = 1 - static_cast<double>(i) / static_cast<double>(cells);
    return 1 - r * r * (1 - low);
  }
  static constexpr std::size_t cells = 900;
  static constexpr double low = 1 - 2 * window;
  std::vector<Terms> integral_;
};

struct EdgeShapes {
  EdgeShape low, high;
};

EdgeShapes edge_shapes(const model::Printer& printer) {
  const optics::View view = optics::projector_view(printer);
  const SightLines side(printer);
  const double edge_mm = column_of_impact_mm(view, grazing_mm(view));
  return {{printer, side, edge_mm, -1}, {printer, side, edge_mm, 1}};
}

// Outer radius of the vial whose outermost lit column is at R_e; impact_mm() has the sign right [physics §12]. Where
// the resin, not the glass, ends the light, the glass is a wall further out.
double radius_mm(const model::Printer& printer, double edge_px) {
  const optics::View view = optics::projector_view(printer);
  const double impact = optics::impact_mm(view, edge_px * printer.projector.pixel_mm);
  if (grazing_mm(view) >= view.shells.front().radius_mm * (1 - 1e-12)) return impact;
  return impact * optics::resin_radius_mm(view) / grazing_mm(view) + printer.vial.wall_mm;
}

// Columns of the two steepest changes, smoothed over three frames, and the smoothed signal's range.
struct Steepest {
  double rise = 0, fall = 0;
  bool clear = false;
};

Steepest steepest(const std::vector<double>& column, const std::vector<double>& signal) {
  const std::size_t n = signal.size();
  std::vector<double> smooth(n);
  double noise = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t a = i > 0 ? i - 1 : i;
    const std::size_t b = std::min(i + 1, n - 1);
    smooth[i] = (signal[a] + signal[i] + signal[b]) / 3;
  }
  const auto [low, high] = std::minmax_element(smooth.begin(), smooth.end());
  // The half height, seen from either end: the slope may be steeper inside where noise helps it.
  const double half = 0.5 * (*low + *high);
  Steepest edges;
  std::size_t first = 0;
  while (first < n && smooth[first] < half) ++first;
  std::size_t last = n;
  while (last > first && smooth[last - 1] < half) --last;
  for (std::size_t i = 1; i < n; ++i) noise += std::abs(signal[i] - signal[i - 1]);
  noise /= static_cast<double>(n - 1);
  edges.clear = first > 0 && last < n && last > first + 3 && *high - *low > 3 * noise;
  if (edges.clear) {
    edges.rise = 0.5 * (column[first - 1] + column[first]);
    edges.fall = 0.5 * (column[last - 1] + column[last]);
  }
  return edges;
}

// Parameters: centre, R_e, blur; then the light: background, and the camera's share at the low and at the high edge.
enum : std::size_t {
  centre,
  edge,
  blur,
  ground,
  low_share,
  high_share = low_share + powers,
  count = high_share + powers
};
constexpr std::size_t lights = count - ground;

class BandModel {
 public:
  BandModel(const SweepScan& scan, const std::vector<double>& signal, const EdgeShapes& shapes, const Steepest& first)
      : shapes_(shapes), width_px_(scan.width_px) {
    const double middle = 0.5 * (first.rise + first.fall);
    const double radius = 0.5 * (first.fall - first.rise);
    for (std::size_t i = 0; i < signal.size(); ++i) {
      const double q = std::abs(scan.column[i] - middle) / radius;
      if (q < 1 - window || q > 1 + window) continue;
      column_.push_back(scan.column[i]);
      signal_.push_back(signal[i]);
    }
  }

  // Row-major, a row for each reading: what each parameter of the light would give if it were 1.
  [[nodiscard]] std::vector<double> light(const std::vector<double>& p) const {
    std::vector<double> rows(signal_.size() * lights);
    for (std::size_t i = 0; i < signal_.size(); ++i) {
      double* row = rows.data() + i * lights;
      const bool high = column_[i] > p[centre];
      const Terms terms =
          blurred(high ? shapes_.high : shapes_.low, std::abs(column_[i] - p[centre]), p[edge], p[blur]);
      row[0] = 1;
      std::copy(terms.begin(), terms.end(), row + (high ? high_share : low_share) - ground);
    }
    return rows;
  }
  [[nodiscard]] std::vector<double> residuals(const std::vector<double>& rows, const double* parts) const {
    std::vector<double> out = signal_;
    for (std::size_t i = 0; i < out.size(); ++i) {
      for (std::size_t k = 0; k < lights; ++k) out[i] -= parts[k] * rows[i * lights + k];
    }
    return out;
  }
  // Of the light's parameters those that bring it nearest to the readings; with an even share only the first of each
  // edge's terms.
  [[nodiscard]] std::vector<double> best_parts(std::vector<double> rows, bool even) const {
    for (std::size_t i = 0; even && i < signal_.size(); ++i) {
      for (const std::size_t share : {low_share, high_share}) {
        for (std::size_t k = 1; k < powers; ++k) rows[i * lights + share - ground + k] = 0;
      }
    }
    return stats::linear_fit(rows, lights, signal_);
  }

 private:
  // Mean over the line's width and a Gaussian, in R_e's units.
  [[nodiscard]] Terms blurred(const EdgeShape& shape, double x_px, double edge_px, double blur_px) const {
    constexpr int half_nodes = 6;
    constexpr double reach = 3;
    const double sigma = std::max(std::abs(blur_px), 1e-3);
    Terms sum{};
    double weights = 0;
    for (int n = -half_nodes; n <= half_nodes; ++n) {
      const double z = reach * n / half_nodes;
      const double weight = std::exp(-0.5 * z * z);
      const double x = x_px + sigma * z;
      const Terms beyond = shape.integral((x + 0.5 * width_px_) / edge_px);
      const Terms before = shape.integral((x - 0.5 * width_px_) / edge_px);
      weights += weight;
      for (std::size_t k = 0; k < powers; ++k) sum[k] += weight * (beyond[k] - before[k]);
    }
    for (double& term : sum) term *= edge_px / width_px_ / weights;
    return sum;
  }

  const EdgeShapes& shapes_;
  double width_px_;
  std::vector<double> column_;
  std::vector<double> signal_;
};

struct BandEdges {
  stats::Measured centre, edge, blur;
};

// First the edges alone, with the light that suits them best, of an even share: from far away, a wide blur and a bent
// share may take an edge's place. Then all together, for the sigmas.
BandEdges fit_band(const SweepScan& scan, const std::vector<double>& signal, const EdgeShapes& shapes,
                   const Steepest& first) {
  using Values = std::vector<double>;
  const std::string subject = "sweep: vial edges";
  const BandModel model(scan, signal, shapes, first);
  const auto lit_best = [&](bool even) {
    return [&model, even](const Values& edges) {
      const Values rows = model.light(edges);
      return model.residuals(rows, model.best_parts(rows, even).data());
    };
  };
  Values at, rows;  // of the edges asked for last: most of the parameters leave them where they are
  const auto residuals = [&](const Values& p) {
    const Values edges(p.begin(), p.begin() + ground);
    if (edges != at) rows = model.light(edges);
    at = edges;
    return model.residuals(rows, p.data() + ground);
  };
  Values start{0.5 * (first.rise + first.fall), 0.5 * (first.fall - first.rise) + 1, 1.5};
  Values step(start.size(), 0.01);
  start = stats::fit_curve(lit_best(true), start, step, subject).value;
  start = stats::fit_curve(lit_best(false), start, step, subject).value;
  const Values parts = model.best_parts(model.light(start), false);
  start.insert(start.end(), parts.begin(), parts.end());
  const auto [low, high] = std::minmax_element(signal.begin(), signal.end());
  step.resize(count, 1e-3 * (*high - *low));
  const auto fit = stats::fit_curve(residuals, start, step, subject);
  BandEdges out{fit.measured(centre), fit.measured(edge), fit.measured(blur)};
  out.blur.value = std::abs(out.blur.value);
  return out;
}

void require_camera_beside(double azimuth_deg) {
  const double from_light_deg = std::acos(std::cos(azimuth_deg * rad_per_deg)) * deg_per_rad;
  if (from_light_deg >= nearest_deg - 1e-9 && from_light_deg <= furthest_deg + 1e-9) return;
  throw Error{Fault::data, "sweep: the camera looks at " + format_number(azimuth_deg) +
                               " degrees to the beam; edges are detected from " + format_number(nearest_deg) + " to " +
                               format_number(furthest_deg) + " on either side (camera.azimuth_deg)"};
}

/// A band with light between two dark sides.
struct LitBand {
  std::size_t band;
  Steepest first;  // where its edges about are
};

std::vector<LitBand> lit_bands(const SweepScan& scan) {
  std::vector<LitBand> lit;
  for (std::size_t b = 0; b < scan.signal.size() && scan.column.size() >= 2 * count; ++b) {
    const Steepest edges = steepest(scan.column, scan.signal[b]);
    if (edges.clear) lit.push_back({b, edges});
  }
  if (!lit.empty()) return lit;
  throw Error{Fault::data, "sweep: no height shows light between two dark sides in " +
                               std::to_string(scan.column.size()) +
                               " frames; sweep beyond both edges of the vial, with the camera exposed"};
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

std::vector<double> band_means(const Image& frame, int bands) {
  if (frame.height < bands) {
    throw Error{Fault::data, "sweep: " + std::to_string(frame.height) + " rows are too few for " +
                                 std::to_string(bands) + " heights"};
  }
  const int rows = frame.height / bands;
  std::vector<double> means(static_cast<std::size_t>(bands));
  for (int b = 0; b < bands; ++b) {
    double sum = 0;
    for (int y = b * rows; y < (b + 1) * rows; ++y) {
      for (int x = 0; x < frame.width; ++x) sum += frame(x, y);
    }
    means[b] = sum / rows / frame.width;
  }
  return means;
}

VialEdges find_edges(const SweepScan& scan, const model::Printer& printer) {
  require_camera_beside(printer.camera.azimuth_deg);
  const std::vector<LitBand> lit = lit_bands(scan);
  // How the camera sees an edge depends a little on the radius: the one that the steepest changes give will do.
  model::Printer about = printer;
  about.vial.radius_mm = radius_mm(printer, 0.5 * (lit.front().first.fall - lit.front().first.rise));
  VialEdges out;
  fit_bands(scan, edge_shapes(about), lit, out);
  fit_axis(scan, printer.projector.pixel_mm, lit, out);
  const double edge_px = out.edge_px.value;
  const double slope = radius_mm(printer, edge_px + 1) - radius_mm(printer, edge_px);
  out.radius_mm = {radius_mm(printer, edge_px), slope * out.edge_px.sigma, out.edge_px.n};
  return out;
}

}  // namespace vam::metrology
