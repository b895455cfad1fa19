// SPDX-License-Identifier: GPL-3.0-or-later
#include "sim/bench/world.hpp"

#include <sys/stat.h>

#include <algorithm>
#include <cmath>

#include "base/error.hpp"
#include "base/index.hpp"
#include "base/text/json.hpp"
#include "sim/bench/print.hpp"

namespace vam::sim {

namespace {
constexpr double kept_s = 5;  // of the logs, for a camera that looks back
constexpr double finest_turn_deg = 0.5;
constexpr int most_parts = 8;
constexpr double cured_turn_deg = 1, cured_s = 1;  // at most in one piece
constexpr std::chrono::milliseconds most_at_once{300};
constexpr double late_s = 0.2;  // that logs may come after what they tell

// What the camera sees of it; with a filter that lets no projector light through (no images), nothing.
const GreyImage* image(const std::vector<GreyImage>& images, int frame) {
  if (frame < 0 || images.empty()) return nullptr;
  return &images[std::min(static_cast<std::size_t>(frame), images.size() - 1)];
}

}  // namespace

SimWorld::SimWorld(SimSources sources, double start_s, SimPrint* print)
    : sources_(std::move(sources)),
      start_s_(start_s),
      print_(print),
      images_(std::make_shared<const Images>(std::move(sources_.images))),
      angles_{sources_.angles},
      shown_{sources_.shown} {
  if (print_ == nullptr) return;
  read_logs();
  cure(start_s - late_s, std::chrono::hours(1));
}

void SimWorld::Log::each_new(const std::function<void(const Json&)>& take) {
  struct stat named = {};
  const bool is_there = !path.empty() && stat(path.c_str(), &named) == 0;  // asked before the last of the old is read
  const auto read_on = [&] {
    for (Json line; lines && lines->next(line);) take(line);
  };
  read_on();
  if (!is_there || (lines && file == named.st_ino)) return;
  lines.emplace(path);
  file = named.st_ino;
  read_on();
}

void SimWorld::read_logs() {
  angles_.each_new([this](const Json& line) {
    const std::string event = line.value("event", "");
    const double t_s = line.value("t_monotonic_s", 0.0);
    if (event == "angle") {
      stage_.push_back({t_s, line.value("angle_deg", 0.0), line.value("speed_deg_s", 0.0)});
    } else if (event == "zeroed" || event == "standing") {
      stage_.push_back({t_s, line.value("angle_deg", stage_.empty() ? 0.0 : stage_.back().angle_deg), 0});
    }
  });
  shown_.each_new([this](const Json& line) { show(line); });
}

// Light that is still to be followed is that of the images of its own flips.
void SimWorld::show(const Json& event) {
  const std::string name = event.value("event", "");
  if (name == "pattern" && sources_.draw) images_ = std::make_shared<const Images>(sources_.draw(event));
  if (name == "frames" && !images_->empty() && sources_.renew) {
    images_ = std::make_shared<const Images>(sources_.renew(event, count_of(*images_)));
  } else if (name == "frames" && !images_->empty()) {
    throw Error{Fault::data, sources_.shown + ": shows other frames since turn " +
                                 std::to_string(event.value("turn", 0)) +
                                 ", which the simulated camera does not follow; print without --frames-from"};
  }
  if (name != "flip") return;
  const double t_s = event.value("t_monotonic_s", 0.0) + sources_.latency_s;
  double lit_s = 0;
  if (!flips_.empty()) {
    lit_s = flips_.back().lit_before_s;
    if (flips_.back().frame >= 0) lit_s += t_s - flips_.back().t_s;
  }
  flips_.push_back({t_s, event.value("frame", -1), lit_s, images_});
}

void SimWorld::forget() {
  const auto old = [this](double t_s, double last_s) {
    return t_s < last_s - kept_s && (!cured_s_ || t_s < *cured_s_);
  };
  while (stage_.size() > 2 && old(stage_[1].t_s, stage_.back().t_s)) stage_.pop_front();
  while (flips_.size() > 2 && old(flips_[1].t_s, flips_.back().t_s)) flips_.pop_front();
}

// Light of the logs, image by image, the stage turning by a degree at most meanwhile; what is in them by then only.
// Limited in time once a client waits for its frame: the rest follows with the next frames.
void SimWorld::cure(double until_s, std::chrono::milliseconds most) {
  if (!cured_s_) cured_s_ = flips_.empty() ? start_s_ : std::min(start_s_, flips_.front().t_s);
  std::vector<double> cuts{*cured_s_};
  for (const Shown& flip : flips_) {
    if (flip.t_s > *cured_s_ && flip.t_s < until_s) cuts.push_back(flip.t_s);
  }
  cuts.push_back(until_s);
  const auto stop = std::chrono::steady_clock::now() + most;
  for (std::size_t i = 0; i + 1 < cuts.size(); ++i) {
    const double seconds = cuts[i + 1] - cuts[i];
    if (!(seconds > 0)) continue;
    const bool dark = moment(0.5 * (cuts[i] + cuts[i + 1])).image == nullptr;
    const double turn_deg = std::abs(angle_deg(cuts[i + 1]) - angle_deg(cuts[i]));
    const int parts = std::max(ceil_int(seconds / cured_s), dark ? 0 : ceil_int(turn_deg / cured_turn_deg));
    for (int n = 0; n < parts; ++n) {
      const SimMoment now = moment(cuts[i] + (n + 0.5) * seconds / parts);
      print_->pass(now.image, now.angle_deg, seconds / parts);
      cured_s_ = cuts[i] + (n + 1) * seconds / parts;
      if (std::chrono::steady_clock::now() > stop) return;
    }
  }
}

double SimWorld::angle_deg(double t_s) const {
  if (sources_.angles.empty()) return sources_.speed_deg_s * (t_s - start_s_);
  const auto after =
      std::find_if(stage_.begin(), stage_.end(), [&](const TableSample& sample) { return sample.t_s > t_s; });
  if (after == stage_.begin()) return stage_.empty() ? 0 : stage_.front().angle_deg;
  const TableSample& before = *(after - 1);
  const double later_s = std::min(t_s - before.t_s, 0.1);  // longer than any silence of a stage that moves
  return before.angle_deg + before.speed_deg_s * later_s;
}

SimMoment SimWorld::moment(double t_s) const {
  SimMoment moment;
  moment.print = print_;
  moment.angle_deg = angle_deg(t_s);
  if (sources_.shown.empty()) {
    moment.image = image(*images_, 0);
    moment.lit_s = std::max(0.0, t_s - start_s_);
    return moment;
  }
  const auto after = std::find_if(flips_.begin(), flips_.end(), [&](const Shown& flip) { return flip.t_s > t_s; });
  if (after == flips_.begin()) return moment;
  const Shown& now = *(after - 1);
  moment.lit_s = now.lit_before_s;
  if (now.frame >= 0) moment.lit_s += t_s - now.t_s;
  moment.image = image(*now.images, now.frame);
  return moment;
}

std::vector<SimMoment> SimWorld::during(double from_s, double to_s) {
  read_logs();
  if (print_ != nullptr) cure(from_s - late_s, most_at_once);
  forget();
  const double turn_deg = std::abs(angle_deg(to_s) - angle_deg(from_s));
  const int parts = std::clamp(ceil_int(turn_deg / finest_turn_deg), 1, most_parts);
  std::vector<double> cuts;
  for (int i = 0; i <= parts; ++i) cuts.push_back(from_s + (to_s - from_s) * i / parts);
  for (const Shown& flip : flips_) {
    if (flip.t_s > from_s && flip.t_s < to_s) cuts.push_back(flip.t_s);
  }
  std::sort(cuts.begin(), cuts.end());
  std::vector<SimMoment> exposure;
  for (std::size_t i = 0; i + 1 < cuts.size(); ++i) {
    exposure.push_back(moment(0.5 * (cuts[i] + cuts[i + 1])));
    exposure.back().share = (cuts[i + 1] - cuts[i]) / (to_s - from_s);
  }
  return exposure;
}

}  // namespace vam::sim
