// SPDX-License-Identifier: GPL-3.0-or-later
#include "metrology/calibrate/private/edges.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>

#include "base/error.hpp"
#include "base/stats/curve_fit.hpp"
#include "base/text/text.hpp"
#include "optics/chief_ray.hpp"
#include "optics/writable_radius.hpp"

namespace vam::metrology {

namespace {

constexpr std::size_t cells = 900;
constexpr double lowest_edge = 1 - 2 * edge_window;

// Denser towards the edge.
double node(std::size_t i) {
  const double r = 1 - static_cast<double>(i) / static_cast<double>(cells);
  return 1 - r * r * (1 - lowest_edge);
}

}  // namespace

EdgeShape::EdgeShape(const model::Printer& printer, const SightLines& side, double edge_mm, double sign)
    : integral_{EdgeTerms{}} {
  const optics::View view = optics::projector_view(printer);
  const double most_rad = std::abs(optics::edge_column(view).ray.delta_rad);
  for (std::size_t i = 1; i <= cells; ++i) {
    const double q = 0.5 * (node(i - 1) + node(i));
    const auto ray = optics::chief_ray(view, sign * q * edge_mm);
    const double t = most_rad - std::abs(ray.delta_rad) + 1 - q;
    const double width = node(i) - node(i - 1);
    double cell = width * side.seen(ray);
    EdgeTerms sum = integral_.back();
    for (std::size_t k = 0; k < edge_powers; ++k, cell *= t) sum[k] += cell;
    integral_.push_back(sum);
  }
}

EdgeTerms EdgeShape::integral(double q) const {
  if (q >= 1) return integral_.back();
  const double place = q <= lowest_edge ? 0 : (1 - std::sqrt((1 - q) / (1 - lowest_edge))) * static_cast<double>(cells);
  const auto cell = std::min(static_cast<std::size_t>(place), cells - 1);
  const double part = (q - node(cell)) / (node(cell + 1) - node(cell));  // linear in q between the nodes
  EdgeTerms out{};
  for (std::size_t k = 0; k < edge_powers; ++k) {
    out[k] = integral_[cell][k] + part * (integral_[cell + 1][k] - integral_[cell][k]);
  }
  return out;
}

EdgeShapes edge_shapes(const model::Printer& printer) {
  const optics::View view = optics::projector_view(printer);
  const SightLines side(printer);
  const double edge_mm = optics::column_of_impact(view, optics::grazing_impact_mm(view));
  return {{printer, side, edge_mm, -1}, {printer, side, edge_mm, 1}};
}

namespace {

// Parameters: centre, R_e, blur; then the light: background, and the camera's share at the low and at the high edge.
enum : std::size_t {
  centre,
  edge,
  blur,
  ground,
  low_share,
  high_share = low_share + edge_powers,
  unknowns = high_share + edge_powers
};
constexpr std::size_t lights = unknowns - ground;
static_assert(least_readings == 2 * unknowns);

class BandModel {
 public:
  BandModel(const SweepScan& scan, const std::vector<double>& signal, const EdgeShapes& shapes,
            const SteepestEdges& first)
      : shapes_(shapes), width_px_(scan.width_px) {
    const double middle = 0.5 * (first.rise + first.fall);
    const double radius = 0.5 * (first.fall - first.rise);
    for (std::size_t i = 0; i < signal.size(); ++i) {
      const double q = std::abs(scan.column[i] - middle) / radius;
      if (q < 1 - edge_window || q > 1 + edge_window) continue;
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
      const EdgeTerms terms =
          blurred(high ? shapes_.high : shapes_.low, std::abs(column_[i] - p[centre]), p[edge], p[blur]);
      row[0] = 1;
      std::copy(terms.begin(), terms.end(), row + (high ? high_share : low_share) - ground);
    }
    return rows;
  }
  [[nodiscard]] std::vector<double> residuals(const std::vector<double>& rows, const std::vector<double>& parts) const {
    std::vector<double> out = stats::sums_of(rows, parts);
    std::transform(signal_.begin(), signal_.end(), out.begin(), out.begin(), std::minus<>());
    return out;
  }
  // The light's parameters that fit the readings best; with an even share only the first of each edge's terms.
  [[nodiscard]] std::vector<double> best_parts(std::vector<double> rows, bool even) const {
    for (std::size_t i = 0; even && i < signal_.size(); ++i) {
      for (const std::size_t share : {low_share, high_share}) {
        for (std::size_t k = 1; k < edge_powers; ++k) rows[i * lights + share - ground + k] = 0;
      }
    }
    return stats::linear_fit(rows, lights, signal_);
  }

 private:
  // Mean over the line's width and a Gaussian, in R_e's units.
  [[nodiscard]] EdgeTerms blurred(const EdgeShape& shape, double x_px, double edge_px, double blur_px) const {
    constexpr int half_nodes = 6;
    constexpr double reach = 3;
    const double sigma = std::max(std::abs(blur_px), 1e-3);
    EdgeTerms sum{};
    double weights = 0;
    for (int n = -half_nodes; n <= half_nodes; ++n) {
      const double z = reach * n / half_nodes;
      const double weight = std::exp(-0.5 * z * z);
      const double x = x_px + sigma * z;
      const EdgeTerms beyond = shape.integral((x + 0.5 * width_px_) / edge_px);
      const EdgeTerms before = shape.integral((x - 0.5 * width_px_) / edge_px);
      weights += weight;
      for (std::size_t k = 0; k < edge_powers; ++k) sum[k] += weight * (beyond[k] - before[k]);
    }
    for (double& term : sum) term *= edge_px / width_px_ / weights;
    return sum;
  }

  const EdgeShapes& shapes_;
  double width_px_;
  std::vector<double> column_;
  std::vector<double> signal_;
};

/// On either side of it is half of what is above the ground.
std::ptrdiff_t half_of_light(const std::vector<double>& signal, double ground) {
  std::vector<double> before(signal.size());
  std::transform_inclusive_scan(signal.begin(), signal.end(), before.begin(), std::plus<>(),
                                [ground](double light) { return light - ground; });
  return std::lower_bound(before.begin(), before.end(), 0.5 * before.back()) - before.begin();
}

}  // namespace

SteepestEdges steepest(const std::vector<double>& column, const std::vector<double>& signal) {
  const std::size_t n = signal.size();
  std::vector<double> smooth(n);
  double noise = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t a = i > 0 ? i - 1 : i;
    const std::size_t b = std::min(i + 1, n - 1);
    smooth[i] = (signal[a] + signal[i] + signal[b]) / 3;
  }
  const auto [low, high] = std::minmax_element(smooth.begin(), smooth.end());
  // Half the height of either half of the light, seen from its end: absorption and refraction may make one edge several
  // times as bright as the other, and the slope may be steeper inside where noise helps it.
  const auto middle = smooth.begin() + half_of_light(smooth, *low);
  const double rises = 0.5 * (*low + *std::max_element(smooth.begin(), middle + 1));
  const double falls = 0.5 * (*low + *std::max_element(middle, smooth.end()));
  SteepestEdges edges;
  std::size_t first = 0;
  while (first < n && smooth[first] < rises) ++first;
  std::size_t last = n;
  while (last > first && smooth[last - 1] < falls) --last;
  for (std::size_t i = 1; i < n; ++i) noise += std::abs(signal[i] - signal[i - 1]);
  noise /= static_cast<double>(n - 1);
  edges.clear = first > 0 && last < n && last > first + 3 && *high - *low > 3 * noise;
  if (edges.clear) {
    edges.rise = 0.5 * (column[first - 1] + column[first]);
    edges.fall = 0.5 * (column[last - 1] + column[last]);
  }
  return edges;
}

// First the edges alone, with the light that suits them best, of an even share: from far away, a wide blur and a bent
// share may take an edge's place. So they may with a sweep of wide steps whose signal is half its height far inside the
// edges: the best of several radii is taken. Then all together, for the sigmas.
BandEdges fit_band(const SweepScan& scan, const std::vector<double>& signal, const EdgeShapes& shapes,
                   const SteepestEdges& first) {
  using Values = std::vector<double>;
  const std::string subject = "sweep: vial edges";
  const BandModel model(scan, signal, shapes, first);
  const auto lit_best = [&](bool even) {
    return [&model, even](const Values& edges) {
      const Values rows = model.light(edges);
      return model.residuals(rows, model.best_parts(rows, even));
    };
  };
  Values at, rows;  // of the edges computed last: most of the parameters leave them where they are
  const auto residuals = [&](const Values& p) {
    const Values edges(p.begin(), p.begin() + ground);
    if (edges != at) rows = model.light(edges);
    at = edges;
    return model.residuals(rows, {p.begin() + ground, p.end()});
  };
  const double middle = 0.5 * (first.rise + first.fall);
  const double radius = 0.5 * (first.fall - first.rise);
  Values step(ground, 0.01);
  stats::CurveFit even;
  for (const double wider : {1.0, 1 + edge_window / 3, 1 + 2 * edge_window / 3}) {
    auto one = stats::fit_curve(lit_best(true), {middle, wider * radius + 1, 1.5}, step, subject);
    if (even.n == 0 || one.rms < even.rms) even = std::move(one);
  }
  Values start = stats::fit_curve(lit_best(false), even.value, step, subject).value;
  const Values parts = model.best_parts(model.light(start), false);
  start.insert(start.end(), parts.begin(), parts.end());
  const auto [low, high] = std::minmax_element(signal.begin(), signal.end());
  step.resize(unknowns, 1e-3 * (*high - *low));
  const auto fit = stats::fit_curve(residuals, start, step, subject);
  const double furthest = (1 + edge_window) * radius;  // where readings are
  if (fit.value[centre] - fit.value[edge] < middle - furthest ||
      fit.value[centre] + fit.value[edge] > middle + furthest) {
    throw Error{Fault::data, subject + ": the fit leaves columns " + format_number(middle - furthest, 4) + " to " +
                                 format_number(middle + furthest, 4) +
                                 ", where light ends; sweep in smaller steps (--pitch), and expose the camera longer"};
  }
  BandEdges out{fit.measured(centre), fit.measured(edge), fit.measured(blur)};
  out.blur.value = std::abs(out.blur.value);
  return out;
}

}  // namespace vam::metrology
