// SPDX-License-Identifier: GPL-3.0-or-later
#include "vam-convert/stage_angles.hpp"

#include <algorithm>
#include <cmath>

#include "base/error.hpp"
#include "base/index.hpp"
#include "base/stats/median.hpp"
#include "base/text/printable.hpp"

namespace vam::convert_tool {

namespace {

constexpr const char* remedy = "; give --view-step where they are to be taken as even";

void require_finite(const StatedViews& views, const std::string& name) {
  const auto bad = std::find_if(views.angles_deg.begin(), views.angles_deg.end(),
                                [](double angle) { return !(std::abs(angle) < 1e9); });
  if (bad == views.angles_deg.end()) return;
  throw Error{Fault::data, name + ": angle " + std::to_string(bad - views.angles_deg.begin()) + " of " +
                               printable(views.source) + " is no angle" + remedy};
}

}  // namespace

std::vector<double> even_edges_deg(int projections, double step_deg) {
  std::vector<double> edges;
  for (int n = 0; n <= projections; ++n) edges.push_back((n - 0.5) * step_deg);
  return edges;
}

std::vector<double> timed_edges_deg(const StatedViews& views, double speed_deg_s, const std::string& name) {
  if (views.times_s.empty()) {
    throw Error{Fault::usage, "--speed: " + name + " is no video, and has no times; give --view-step"};
  }
  std::vector<double> edges = views.times_s;
  std::vector<double> shown_s;
  for (std::size_t n = 1; n < edges.size(); ++n) shown_s.push_back(edges[n] - edges[n - 1]);
  const double half_s = 0.5 * stats::median(shown_s);
  for (double& edge : edges) edge = speed_deg_s * (edge - half_s);
  return edges;
}

std::vector<double> stated_edges_deg(const StatedViews& views, int projections, const std::string& name) {
  const std::vector<double>& angles = views.angles_deg;
  if (count_of(angles) != projections) {
    throw Error{Fault::data, name + ": has " + std::to_string(angles.size()) + " angles (" + printable(views.source) +
                                 ") of " + std::to_string(projections) + " projections" + remedy};
  }
  require_finite(views, name);
  if (projections == 1) return {angles[0] - 180, angles[0] + 180};
  std::vector<double> edges{0};
  double at = angles[0];
  for (int n = 1; n < projections; ++n) {
    const double step = std::remainder(angles[n] - angles[n - 1], 360.0);
    edges.push_back(at + 0.5 * step);
    at += step;
  }
  edges.push_back(2 * at - edges.back());
  edges[0] = 2 * angles[0] - edges[1];
  return edges;
}

}  // namespace vam::convert_tool
