// SPDX-License-Identifier: GPL-3.0-or-later
#include "vam-convert/turns.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/error.hpp"
#include "base/index.hpp"
#include "base/stats/median.hpp"
#include "base/text/text.hpp"

namespace vam::convert_tool {

namespace {

/// Positions within a thousandth of a row of an edge are on it.
double on_edge(double row) { return std::abs(row - std::round(row)) < 1e-3 ? std::round(row) : row; }

/// The median step; all go one way.
double usual_step_deg(const std::vector<double>& edges_deg, const std::string& name) {
  std::vector<double> steps;
  for (std::size_t n = 1; n < edges_deg.size(); ++n) steps.push_back(edges_deg[n] - edges_deg[n - 1]);
  const double usual = stats::median(steps);
  const auto back = std::find_if(steps.begin(), steps.end(), [&](double step) { return !(step * usual >= 0); });
  if (back == steps.end() && usual != 0) return usual;
  const auto n = back == steps.end() ? 0 : back - steps.begin();
  throw Error{Fault::data, name + ": the stage turns back, or stands: projection " + std::to_string(n) +
                               " is shown from " + format_number(edges_deg[n], 7) + " to " +
                               format_number(edges_deg[n + 1], 7) + " degrees, while the median step is " +
                               format_number(usual, 7) + "; give --view-step where they are to be taken as even"};
}

}  // namespace

Turns::Turns(const std::vector<double>& edges_deg, bool held, const std::string& name) {
  const int projections = count_of(edges_deg) - 1;
  const double step = usual_step_deg(edges_deg, name);
  const double per_turn = std::round(360 / std::abs(step));
  count_ = std::abs(edges_deg.back() - edges_deg.front()) / 360;
  constexpr double least = 0.9;
  if (count_ < least) {
    throw Error{Fault::data, name + ": has " + std::to_string(projections) + " projections, " +
                                 format_number(per_turn) + " make a turn; check --view-step or --speed"};
  }
  const double rows = std::clamp(per_turn, 1.0, 2.0 * projections);
  const bool aligned = std::ranges::all_of(edges_deg, [&](double edge) {
    const double row = on_edge((edge - edges_deg.front()) * rows / 360);
    return row == std::round(row);
  });
  blurred_ = held || !aligned;
  constexpr double fine_rows = 720;  // a turn
  shown_.resize(static_cast<std::size_t>(blurred_ ? rows * std::max(2.0, std::ceil(fine_rows / rows)) : rows));
  const double row_deg = 360.0 / this->rows();
  const bool whole = std::abs(count_ - std::round(count_)) * this->rows() < 0.01;
  if (whole) count_ = std::round(count_);
  const double origin = step > 0 ? edges_deg.front() : whole ? edges_deg.front() - row_deg : edges_deg.back();
  start_deg_ = origin + 0.5 * row_deg;
  start_deg_ -= 360 * std::floor(start_deg_ / 360 + 1e-9);
  for (int n = 0; n < projections; ++n) {
    const auto [from, to] = std::minmax(edges_deg[n], edges_deg[n + 1]);
    add(n, on_edge((from - origin) / row_deg), on_edge((to - origin) / row_deg));
  }
}

void Turns::add(int projection, double from, double to) {
  for (double row = std::floor(from); row < to; ++row) {
    const auto rows = static_cast<float>(std::min(row + 1, to) - std::max(row, from));
    const int at = static_cast<int>(row - this->rows() * std::floor(row / this->rows()));
    shares_.push_back({projection, at, rows});
    shown_[at] += rows;
  }
}

Image Turns::fold(const Image& projections) const {
  Image turn(projections.width, rows());
  for (const Share& share : shares_) {
    float* to = turn.row(share.row);
    const float* from = projections.row(share.projection);
    for (int c = 0; c < turn.width; ++c) to[c] += share.rows * from[c] / shown_[share.row];
  }
  return turn;
}

}  // namespace vam::convert_tool
