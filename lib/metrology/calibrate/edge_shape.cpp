// SPDX-License-Identifier: GPL-3.0-or-later
#include "metrology/calibrate/private/edge_shape.hpp"

#include <algorithm>
#include <cmath>

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

}  // namespace vam::metrology
