// SPDX-License-Identifier: GPL-3.0-or-later
#include "vam-convert/stage_angles.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/error.hpp"
#include "base/index.hpp"
#include "base/log/log.hpp"
#include "base/stats/median.hpp"
#include "base/text/printable.hpp"
#include "base/text/text.hpp"

namespace vam::convert_tool {

namespace {

constexpr double tolerance = 0.1;  // of a step
constexpr const char* remedy = "; give --view-step where they are to be taken as even";

std::string deg(double angle) { return format_number(angle, 7); }

/// From each angle to the next, by the shorter way.
std::vector<double> steps_of(const std::vector<double>& angles_deg) {
  std::vector<double> steps;
  for (std::size_t i = 1; i < angles_deg.size(); ++i) {
    steps.push_back(std::remainder(angles_deg[i] - angles_deg[i - 1], 360.0));
  }
  return steps;
}

void require_finite(const StatedViews& views, const std::string& name) {
  const auto bad = std::find_if(views.angles_deg.begin(), views.angles_deg.end(),
                                [](double angle) { return !(std::abs(angle) < 1e9); });
  if (bad == views.angles_deg.end()) return;
  throw Error{Fault::data, name + ": angle " + std::to_string(bad - views.angles_deg.begin()) + " of " +
                               printable(views.source) + " is no angle" + remedy};
}

/// The first step that is not like the others.
void require_alike(const StatedViews& views, const std::vector<double>& steps, double usual, const std::string& name) {
  const auto other = std::find_if(steps.begin(), steps.end(), [&](double step) {
    return !(std::abs(step - usual) <= tolerance * std::abs(usual));
  });
  if (other == steps.end() && usual != 0) return;
  const auto at = other == steps.end() ? 0 : other - steps.begin();
  throw Error{Fault::data, name + ": the stage angles are uneven: from projection " + std::to_string(at) + " to " +
                               std::to_string(at + 1) + " they go from " + deg(views.angles_deg[at]) + " to " +
                               deg(views.angles_deg[at + 1]) + " degrees, while the median step is " + deg(usual) +
                               " (" + printable(views.source) + ")" + remedy};
}

/// Steps that are alike may still add up to another angle.
void require_in_place(const StatedViews& views, const std::vector<double>& steps, double step,
                      const std::string& name) {
  double sum = 0;
  for (std::size_t i = 0; i < steps.size(); ++i) {
    sum += steps[i];
    const double off = sum - static_cast<double>(i + 1) * step;
    if (std::abs(off) <= tolerance * std::abs(step)) continue;
    throw Error{Fault::data, name + ": the stage angles drift: that of projection " + std::to_string(i + 1) + " is " +
                                 deg(off) + " degrees beside even steps of " + deg(step) + ", of which " +
                                 format_number(std::round(360 / std::abs(step))) + " make a turn (" +
                                 printable(views.source) + ")" + remedy};
  }
}

}  // namespace

StageAngles even_angles(const StatedViews& views, int projections, const std::string& name) {
  if (count_of(views.angles_deg) != projections) {
    throw Error{Fault::data, name + ": has " + std::to_string(views.angles_deg.size()) + " angles (" +
                                 printable(views.source) + ") of " + std::to_string(projections) + " projections" +
                                 remedy};
  }
  require_finite(views, name);
  StageAngles found{std::fmod(std::fmod(views.angles_deg.front(), 360.0) + 360.0, 360.0), 0};
  const std::vector<double> steps = steps_of(views.angles_deg);
  if (steps.empty()) return found;
  const double usual = stats::median(steps);
  require_alike(views, steps, usual, name);
  double sum = 0;
  for (const double step : steps) sum += step;
  const double per_turn = std::round(360 * static_cast<double>(steps.size()) / std::abs(sum));
  found.step_deg = std::copysign(360 / per_turn, usual);
  require_in_place(views, steps, found.step_deg, name);
  note(name + ": " + std::to_string(projections) + " projections from " + deg(found.start_deg) + " deg in steps of " +
       deg(found.step_deg) + " deg, by " + printable(views.source));
  return found;
}

}  // namespace vam::convert_tool
