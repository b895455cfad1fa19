// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/pose.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>
#include <stdexcept>

#include "base/text/printable.hpp"
#include "base/text/text.hpp"

namespace vam::model {

namespace {

constexpr const char* header = "angle_deg,dx_mm,dy_mm,dz_mm,moves";

double distance_mm(const Pose& a, const Pose& b) {
  return std::hypot(a.dx_mm - b.dx_mm, a.dy_mm - b.dy_mm, a.dz_mm - b.dz_mm);
}

std::string moves_name(Moves moves) { return moves == Moves::vial ? "vial" : "part"; }

Moves moves_named(const std::string& name) {
  if (name == "vial") return Moves::vial;
  if (name == "part") return Moves::part;
  throw std::runtime_error("a pose moves '" + name + "', not vial or part");
}

/// Why the displacement is none of this world; empty where it is.
std::string objection(const Pose& pose) {
  constexpr double most_mm = 1e4;
  for (const double mm : {pose.dx_mm, pose.dy_mm, pose.dz_mm}) {
    if (!(std::abs(mm) <= most_mm)) return "is displaced by " + format_number(mm) + " mm; check the unit";
  }
  return "";
}

}  // namespace

Pose pose_of(std::span<const std::string> cells) {
  if (cells.size() != 5) throw std::runtime_error("a pose has " + std::to_string(cells.size()) + " cells, not 5");
  std::array<double, 4> numbers{};
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const auto value = parse_number(cells[i]);
    if (!value || !std::isfinite(*value))
      throw std::runtime_error(split(header, ',')[i] + " " + excerpt(cells[i]) + " is not a number");
    numbers[i] = *value;
  }
  const Pose pose{numbers[0], numbers[1], numbers[2], numbers[3], moves_named(cells[4])};
  if (const std::string why = objection(pose); !why.empty()) throw std::runtime_error("a pose " + why);
  return pose;
}

std::string objection(const Poses& poses, double start_deg, double step_deg) {
  for (std::size_t k = 0; k < poses.size(); ++k) {
    const double want = start_deg + static_cast<double>(k) * step_deg;
    if (std::abs(poses[k].angle_deg - want) <= 0.01 * std::abs(step_deg)) continue;
    return "pose " + std::to_string(k) + " is at " + format_number(poses[k].angle_deg) + " degrees, but frame " +
           std::to_string(k) + " is at " + format_number(want);
  }
  return "";
}

std::string poses_text(const Poses& poses) {
  std::string text = header;
  for (const Pose& pose : poses) {
    text += '\n';
    for (const double number : {pose.angle_deg, pose.dx_mm, pose.dy_mm, pose.dz_mm}) {
      text += format_number(number, 9) + ',';
    }
    text += moves_name(pose.moves);
  }
  return text;
}

Poses parse_poses(const std::string& text) {
  std::istringstream stream(text);
  std::string line;
  std::getline(stream, line);
  if (line != header) throw std::runtime_error("the table of poses does not begin with " + std::string(header));
  Poses poses;
  while (std::getline(stream, line)) poses.push_back(pose_of(split(line, ',')));
  return poses;
}

LiftRange lift_mm(const Poses& poses) {
  if (poses.empty()) return {};
  const auto lower = [](const Pose& a, const Pose& b) { return a.dz_mm < b.dz_mm; };
  const auto [least, most] = std::minmax_element(poses.begin(), poses.end(), lower);
  return {least->dz_mm, most->dz_mm};
}

double farthest_mm(const Poses& poses, Moves moves) {
  double farthest = 0;
  for (const Pose& pose : poses) {
    if (pose.moves == moves) farthest = std::max(farthest, std::hypot(pose.dx_mm, pose.dy_mm));
  }
  return farthest;
}

bool repeat(const Poses& poses) {
  double longest = 0;
  for (std::size_t i = 1; i < poses.size(); ++i) longest = std::max(longest, distance_mm(poses[i - 1], poses[i]));
  constexpr double rounding_mm = 1e-6;
  return poses.empty() || distance_mm(poses.back(), poses.front()) <= 2 * longest + rounding_mm;
}

Pose pose_between(const Poses& poses, double frame) {
  const auto count = static_cast<double>(poses.size());
  const bool round = repeat(poses);
  const double place = round ? frame - count * std::floor(frame / count) : std::clamp(frame, 0.0, count - 1);
  const auto low = std::min(static_cast<std::size_t>(place), poses.size() - 1);
  const std::size_t high = round ? (low + 1) % poses.size() : std::min(low + 1, poses.size() - 1);
  const Pose& a = poses[low];
  const Pose& b = poses[high];
  const double part = place - static_cast<double>(low);
  const auto between = [&](double from, double to) { return from + part * (to - from); };
  const double step_deg = poses.size() > 1 ? poses[1].angle_deg - poses[0].angle_deg : 0;
  return {a.angle_deg + part * step_deg, between(a.dx_mm, b.dx_mm), between(a.dy_mm, b.dy_mm),
          between(a.dz_mm, b.dz_mm), part < 0.5 ? a.moves : b.moves};
}

}  // namespace vam::model
