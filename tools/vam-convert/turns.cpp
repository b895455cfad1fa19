// SPDX-License-Identifier: GPL-3.0-or-later
#include "vam-convert/turns.hpp"

#include <algorithm>
#include <cmath>

#include "base/error.hpp"
#include "base/index.hpp"
#include "base/stats/median.hpp"
#include "base/text/text.hpp"
#include "io/stream/stream.hpp"

namespace vam::convert_tool {

namespace {

constexpr const char* remedy = "; give --view-step where they are to be taken as even";

/// From each value to the next.
std::vector<double> differences(const std::vector<double>& values) {
  std::vector<double> steps;
  for (std::size_t n = 1; n < values.size(); ++n) steps.push_back(values[n] - values[n - 1]);
  return steps;
}

/// The first is at 0 deg in the middle of the usual time.
std::vector<double> timed_edges_deg(const std::vector<double>& times_s, double speed_deg_s, const std::string& name) {
  if (times_s.empty())
    throw Error{Fault::usage, "--speed: " + name + " is no video, and has no times; give --view-step"};
  const double half_s = 0.5 * stats::median(differences(times_s));
  std::vector<double> edges;
  for (const double time_s : times_s) edges.push_back(speed_deg_s * (time_s - half_s));
  return edges;
}

std::vector<double> measured_edges_deg(const std::vector<model::ImageInfo>& frames, const std::string& name) {
  double at = frames.front().angle_deg;
  std::vector<double> edges;
  for (const model::ImageInfo& frame : frames) {
    if (!(std::abs(frame.angle_deg) < 1e9)) {
      throw Error{Fault::data,
                  name + ": angle " + std::to_string(edges.size()) + " of frames.csv is no angle" + remedy};
    }
    const double step = std::remainder(frame.angle_deg - at, 360.0);
    edges.push_back(at + 0.5 * step);
    at += step;
  }
  if (edges.size() == 1) return {at - 180, at + 180};
  edges[0] = 2 * edges[0] - edges[1];
  edges.push_back(2 * at - edges.back());
  return edges;
}

/// Positions within a thousandth of a row of an edge are on it.
double on_edge(double row) { return std::abs(row - std::round(row)) < 1e-3 ? std::round(row) : row; }

/// The median step; all go one way.
double usual_step_deg(const std::vector<double>& edges_deg, const std::string& name) {
  const std::vector<double> steps = differences(edges_deg);
  const double usual = stats::median(steps);
  const auto back = std::find_if(steps.begin(), steps.end(), [&](double step) { return !(step * usual >= 0); });
  if (back == steps.end() && usual != 0) return usual;
  const auto n = back == steps.end() ? 0 : back - steps.begin();
  throw Error{Fault::data, name + ": the stage turns back, or stands: projection " + std::to_string(n) +
                               " is shown from " + format_number(edges_deg[n], 7) + " to " +
                               format_number(edges_deg[n + 1], 7) + " degrees, while the median step is " +
                               format_number(usual, 7) + remedy};
}

}  // namespace

bool are_angles_stated(const Options& options, const io::ImageSource& from) {
  return options.view_step_deg || options.speed_deg_s || !from.about().empty() || from.info().angle_step_deg != 0;
}

std::vector<double> stage_edges_deg(const Options& options, const io::ImageSource& from, int projections) {
  const std::string name = io::input_name(options.input);
  const std::vector<model::ImageInfo> frames = from.about();
  const double stated_deg = from.info().angle_step_deg;
  const double step_deg = options.view_step_deg.value_or(stated_deg != 0 ? stated_deg : 360.0 / projections);
  const bool measured = !options.speed_deg_s && !options.view_step_deg && !frames.empty();
  std::vector<double> edges;
  if (options.speed_deg_s) {
    edges = timed_edges_deg(from.times_s(), *options.speed_deg_s, name);
  } else if (measured) {
    edges = measured_edges_deg(frames, name);
  } else {
    for (int n = 0; n <= projections; ++n) edges.push_back((n - 0.5) * step_deg);
  }
  const Convention& program = convention_of(options.from);
  const double own_first = measured ? frames.front().angle_deg : 0;
  const double first = options.first_angle_deg.value_or(own_first) - own_first;
  for (double& edge : edges) edge = program.zero_deg + program.sense * (first + edge);
  return edges;
}

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
    const auto [from, to] =
        std::minmax({on_edge((edges_deg[n] - origin) / row_deg), on_edge((edges_deg[n + 1] - origin) / row_deg)});
    for (int row = floor_int(from); row < to; ++row) {
      const auto passed = static_cast<float>(std::min(row + 1.0, to) - std::max<double>(row, from));
      const int at = (row % this->rows() + this->rows()) % this->rows();
      shares_.push_back({n, at, passed});
      shown_[at] += passed;
    }
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
