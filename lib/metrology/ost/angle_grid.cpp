// SPDX-License-Identifier: GPL-3.0-or-later
#include "metrology/ost/private/angle_grid.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/error.hpp"
#include "base/index.hpp"
#include "base/stats/median.hpp"
#include "base/text/text.hpp"

namespace vam::metrology {

namespace {

double wrapped(double angle_deg) {
  const double turn = std::fmod(angle_deg, 360.0);
  return turn < 0 ? turn + 360 : turn;
}

// Frames at one angle.
struct AngleCluster {
  double angle_deg;
  std::vector<int> frames;
};

std::vector<AngleCluster> clusters_of(std::span<const double> angles_deg, double closer_deg) {
  std::vector<int> order(angles_deg.size());
  std::iota(order.begin(), order.end(), 0);
  const auto angle = [&](int i) { return wrapped(angles_deg[i]); };
  std::sort(order.begin(), order.end(), [&](int a, int b) { return angle(a) < angle(b); });
  std::vector<AngleCluster> clusters;
  for (const int i : order) {
    if (clusters.empty() || angle(i) - clusters.back().angle_deg > closer_deg) clusters.push_back({angle(i), {}});
    clusters.back().frames.push_back(i);
  }
  for (auto& cluster : clusters) {
    double sum = 0;
    for (const int i : cluster.frames) sum += angle(i);
    cluster.angle_deg = sum / static_cast<double>(cluster.frames.size());
  }
  return clusters;
}

std::vector<double> gaps_of(const std::vector<AngleCluster>& clusters) {
  std::vector<double> gaps;
  for (std::size_t i = 0; i < clusters.size(); ++i) {
    const double next = i + 1 < clusters.size() ? clusters[i + 1].angle_deg : clusters[0].angle_deg + 360;
    gaps.push_back(next - clusters[i].angle_deg);
  }
  return gaps;
}

}  // namespace

AngleGrid::AngleGrid(std::span<const double> angles_deg, int angles, double max_gap_deg) {
  constexpr int fewest = 8;
  std::vector<AngleCluster> clusters = clusters_of(angles_deg, 1e-6);
  if (count_of(clusters) < fewest) {
    throw Error{Fault::data, "views: " + std::to_string(clusters.size()) + " different angles; a turn needs at least " +
                                 std::to_string(fewest)};
  }
  if (angles == 0) angles = std::max(fewest, 2 * round_int(180 / stats::median(gaps_of(clusters))));
  clusters = clusters_of(angles_deg, 36.0 / angles);
  const std::vector<double> gaps = gaps_of(clusters);
  const auto widest = static_cast<std::size_t>(std::max_element(gaps.begin(), gaps.end()) - gaps.begin());
  if (gaps[widest] > max_gap_deg) {
    throw Error{Fault::data, "views: the turn is incomplete, no frame for " + format_number(gaps[widest], 4) +
                                 " deg after " + format_number(clusters[widest].angle_deg, 4) + " deg (" +
                                 format_number(max_gap_deg, 4) + " deg is the maximum gap)"};
  }
  summary_ = {angles, count_of(angles_deg), count_of(angles_deg) - count_of(clusters)};
  taps_.resize(angles);
  for (int a = 0; a < angles; ++a) {
    const double angle = 360.0 * a / angles;
    // The last cluster at or below the angle; before the first one that is the last of all, over the circle.
    const auto above =
        std::upper_bound(clusters.begin(), clusters.end(), angle,
                         [](double value, const AngleCluster& cluster) { return value < cluster.angle_deg; });
    const std::size_t before =
        (static_cast<std::size_t>(above - clusters.begin()) + clusters.size() - 1) % clusters.size();
    const AngleCluster& low = clusters[before];
    const AngleCluster& high = clusters[(before + 1) % clusters.size()];
    const double part = wrapped(angle - low.angle_deg) / gaps[before];
    auto& taps = taps_[a];
    const auto add = [&](const AngleCluster& cluster, double share) {
      if (share == 0) return;
      for (const int i : cluster.frames)
        taps.push_back({i, static_cast<float>(share / static_cast<double>(cluster.frames.size()))});
    };
    add(low, 1 - part);
    add(high, part);
  }
}

Turns::Turns(std::span<const double> angles_deg) {
  constexpr std::size_t fewest = 3;  // that a median distinguishes
  std::vector<std::size_t> first{0};
  double turned_deg = 0;
  for (std::size_t i = 1; i < angles_deg.size(); ++i) {
    turned_deg += std::abs(std::remainder(angles_deg[i] - angles_deg[i - 1], 360.0));
    if (turned_deg + 1e-6 < 360 * static_cast<double>(first.size())) continue;
    first.push_back(i);
  }
  first.push_back(angles_deg.size());
  try {
    for (std::size_t t = 0; t + 1 < first.size(); ++t) {
      const auto frames = angles_deg.subspan(first[t], first[t + 1] - first[t]);
      turns_.push_back({static_cast<int>(first[t]), AngleGrid(frames, t == 0 ? 0 : angles())});
    }
  } catch (const Error&) {  // the last one, or no turns at all
  }
  if (turns_.size() >= fewest && turns_.size() + 2 >= first.size()) return;
  turns_.clear();
  turns_.push_back({0, AngleGrid(angles_deg, 0)});
}

}  // namespace vam::metrology
