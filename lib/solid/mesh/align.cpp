// SPDX-License-Identifier: GPL-3.0-or-later
#include "solid/mesh/align.hpp"

#include <Eigen/Dense>
#include <algorithm>

#include "base/compute/parallel.hpp"
#include "base/index.hpp"
#include "base/log/progress.hpp"
#include "solid/mesh/geometry.hpp"
#include "solid/mesh/private/icp.hpp"

namespace vam::solid {

namespace {

using Eigen::Vector3d;

struct Start {
  double rms;
  Motion pose;
};

std::vector<Start> starts_from(const std::vector<Motion>& poses) {
  std::vector<Start> starts;
  for (const Motion& pose : poses) starts.push_back({0, pose});
  return starts;
}

// Fewer and fewer starts are refined more and more.
template <class RmsOf>
void keep_best(std::vector<Start>& starts, std::size_t count, const RmsOf& rms_of) {
  Progress progress("aligning", count_of(starts));
  parallel_for(count_of(starts), [&](int i) {
    Start& start = starts[i];
    start.rms = rms_of(start.pose);
    progress.tick();
  });
  std::stable_sort(starts.begin(), starts.end(), [](const Start& a, const Start& b) { return a.rms < b.rms; });
  starts.resize(std::min(starts.size(), count));
}

// What alignments of one print have in common.
struct Task {
  const model::TriangleSoup& print;
  const Surface& reference;
  const AlignOptions& options;
  Bounds box;
  std::vector<Vector3d> all;   // samples of the print
  std::vector<Vector3d> some;  // fewer
  std::vector<Vector3d> few;
  std::vector<Vector3d> reference_points;

  [[nodiscard]] double size() const { return box.largest_side(); }
  /// The error after it. A rigid one finds no scale.
  double icp(const std::vector<Vector3d>& points, bool rigid, int most, Motion& start,
             double reach = everywhere) const {
    AlignOptions how = options;
    how.with_scale = options.with_scale && !rigid;
    return run_icp(points, reference, how, most, size(), start, reach).rms_mm;
  }
};

Alignment align_whole(const Task& task, Motion& pose) {
  std::vector<Start> starts = starts_from(starting_poses(task.all, task.reference_points, task.options.with_scale));
  keep_best(starts, 96, [&](Motion& start) { return pair_up(task.few, start, task.reference).rms; });
  keep_best(starts, 12, [&](Motion& start) { return task.icp(task.few, true, 6, start); });
  keep_best(starts, 3, [&](Motion& start) { return task.icp(task.few, true, 20, start); });
  // The best at a tenth of the points, then all points from there.
  keep_best(starts, 1, [&](Motion& start) { return task.icp(task.some, false, task.options.max_iterations, start); });
  pose = starts.front().pose;
  return run_icp(task.all, task.reference, task.options, task.options.max_iterations, task.size(), pose);
}

// The samples of the print at a pose; whether one of them is within 4 % of the size, about twice the distance between
// samples.
class PlacedSamples {
 public:
  PlacedSamples(const Task& task, const Motion& pose) : near2_(std::pow(0.04 * task.size(), 2)) {
    for (const Vector3d& p : task.all) moved_.push_back(pose(p));
  }
  [[nodiscard]] bool has_near(const Vector3d& q) const {
    return std::any_of(moved_.begin(), moved_.end(), [&](const auto& p) { return (p - q).squaredNorm() < near2_; });
  }

 private:
  double near2_;
  std::vector<Vector3d> moved_;
};

// Share of the reference's points that have a sample of the print near.
double overlap_of(const Task& task, const Motion& pose) {
  constexpr std::size_t asked = 1000;
  const PlacedSamples print(task, pose);
  const std::size_t every = std::max<std::size_t>(1, task.reference_points.size() / asked);
  const auto count = static_cast<int>(task.reference_points.size() / every);
  std::vector<char> covered(count);
  parallel_for(count, [&](int i) { covered[i] = print.has_near(task.reference_points[i * every]) ? 1 : 0; });
  return static_cast<double>(std::count(covered.begin(), covered.end(), char{1})) / std::max(1, count);
}

double apart(const Task& task, const Motion& a, const Motion& b) {
  double sum = 0;
  for (const Vector3d& p : task.few) sum += (a(p) - b(p)).norm();
  return sum / static_cast<double>(task.few.size());
}

// Motions that lay the reference onto itself, within 2 % of its size.
std::vector<Motion> symmetries(const Task& task) {
  constexpr double alike = 0.02;
  std::vector<Vector3d> few;
  const std::size_t every = std::max<std::size_t>(1, task.reference_points.size() / 300);
  for (std::size_t i = 0; i < task.reference_points.size(); i += every) few.push_back(task.reference_points[i]);
  std::vector<Motion> found;
  std::vector<Motion> starts = starting_poses(task.reference_points, task.reference_points, false);
  std::vector<char> symmetric(starts.size());
  parallel_for(count_of(starts), [&](int i) {
    task.icp(few, true, 15, starts[i]);  // principal axes of a cube are any
    const Pairs pairs = pair_up(few, starts[i], task.reference);
    symmetric[i] = *std::max_element(pairs.far.begin(), pairs.far.end()) < alike * task.size() ? 1 : 0;
  });
  for (std::size_t i = 0; i < starts.size(); ++i) {
    if (symmetric[i] != 0) found.push_back(starts[i]);
  }
  return found;
}

// Is the print at one pose where it is at the other, but for symmetries of the reference and its own? Its samples then
// have one of the other pose near.
bool is_same_place(const Task& task, const Motion& one, const Motion& other, const std::vector<Motion>& symmetric) {
  const PlacedSamples there(task, other);
  return std::any_of(symmetric.begin(), symmetric.end(), [&](const Motion& motion) {
    return std::all_of(task.few.begin(), task.few.end(),
                       [&](const Vector3d& p) { return there.has_near(motion(one(p))); });
  });
}

// The best of poses that lie 5 % of the size apart.
void keep_distinct(const Task& task, std::vector<Start>& starts, std::size_t count) {
  constexpr double another = 0.05;
  std::vector<Start> kept;
  for (const Start& start : starts) {
    const bool known = std::any_of(kept.begin(), kept.end(), [&](const Start& other) {
      return apart(task, start.pose, other.pose) < another * task.size();
    });
    if (!known) kept.push_back(start);
    if (kept.size() == count) break;
  }
  starts = std::move(kept);
}

// Share of the samples that match within this distance.
double matching(const Pairs& pairs, double within_mm) {
  const auto count = std::count_if(pairs.far.begin(), pairs.far.end(), [&](double far) { return far < within_mm; });
  return static_cast<double>(count) / static_cast<double>(pairs.far.size());
}

// The other pose in which most samples match, if nine tenths as many do as in the best: how much of a part is broken
// off, and matches nothing, is not known so well.
std::optional<AmbiguousPose> rival_of(const Task& task, const std::vector<Start>& starts) {
  constexpr double as_well = 0.9;
  constexpr double another = 0.02;  // of the size, that samples lie apart
  const Motion& best = starts.front().pose;
  const Pairs pairs = pair_up(task.some, best, task.reference);
  const double within_mm = std::max(4 * deviation_of(pairs), 2e-3 * task.size());
  std::vector<Motion> symmetric;
  AmbiguousPose rival;
  rival.best_match = matching(pairs, within_mm);
  for (const Start& start : starts) {
    const double apart_mm = apart(task, best, start.pose);
    if (apart_mm < another * task.size()) continue;
    const double match = matching(pair_up(task.some, start.pose, task.reference), within_mm);
    if (match <= rival.match || match < as_well * rival.best_match) continue;
    if (symmetric.empty()) symmetric = symmetries(task);
    if (is_same_place(task, best, start.pose, symmetric)) continue;
    rival = {to_similarity(start.pose), match, rival.best_match, apart_mm};
  }
  return rival.match > 0 ? std::optional(rival) : std::nullopt;
}

// Rotations that may lay the print, where it is, onto another place of the reference: those of its own principal frame,
// of the reference's, and those of a cube.
std::vector<Eigen::Matrix3d> other_rotations(const Task& task, const Motion& pose) {
  std::vector<Vector3d> placed;
  for (const Vector3d& p : task.some) placed.push_back(pose(p));
  std::vector<Eigen::Matrix3d> all;
  for (const auto& points : {placed, task.reference_points}) {
    for (const Motion& motion : starting_poses(points, points, false))
      all.emplace_back(motion.rotation * pose.rotation);
  }
  for (const Eigen::Matrix3d& turn : cube_rotations()) all.emplace_back(turn * pose.rotation);
  return all;
}

Alignment align_part(const Task& task, const Motion& whole) {
  constexpr double reach = 0.05;  // of the size
  const double reach_mm = reach * task.size();
  const OverlapSearch search(task.box, task.reference);
  const auto found_from = [&](const std::vector<Motion>& poses) {
    std::vector<Start> starts = starts_from(poses);
    keep_best(starts, 200, [&](Motion& start) { return task.icp(task.few, true, 6, start, reach_mm); });
    keep_distinct(task, starts, 80);
    keep_best(starts, 80, [&](Motion& start) { return task.icp(task.few, true, 20, start, reach_mm); });
    return starts;
  };
  std::vector<Motion> poses = search.poses(task.few, even_rotations(), 1, 400);
  poses.push_back(whole);
  std::vector<Start> starts = found_from(poses);
  // Again from the best: whether another place is found as good must not depend on how the print was turned.
  const auto others = found_from(search.poses(task.few, other_rotations(task, starts.front().pose), 3, 200));
  starts.insert(starts.end(), others.begin(), others.end());
  std::stable_sort(starts.begin(), starts.end(), [](const Start& a, const Start& b) { return a.rms < b.rms; });
  keep_distinct(task, starts, 24);
  keep_best(starts, 24,
            [&](Motion& start) { return task.icp(task.some, false, task.options.max_iterations, start, reach_mm); });
  Motion pose = starts.front().pose;
  Alignment found =
      run_icp(task.all, task.reference, task.options, task.options.max_iterations, task.size(), pose, reach_mm);
  found.overlap = overlap_of(task, pose);
  found.rival = rival_of(task, starts);
  return found;
}

}  // namespace

Vector3 Similarity::operator()(const Vector3& x) const {
  return {scale * dot(rotation[0], x) + shift_mm[0], scale * dot(rotation[1], x) + shift_mm[1],
          scale * dot(rotation[2], x) + shift_mm[2]};
}

std::array<std::array<double, 4>, 4> Similarity::matrix() const {
  std::array<std::array<double, 4>, 4> m{};
  for (std::size_t r = 0; r < 3; ++r) {
    for (std::size_t c = 0; c < 3; ++c) m[r][c] = scale * rotation[r][c];
    m[r][3] = shift_mm[r];
  }
  m[3][3] = 1;
  return m;
}

Alignment refine(const model::TriangleSoup& print, const Surface& reference, const AlignOptions& options) {
  Motion pose;
  return run_icp(points_of(print, options.samples), reference, options, options.max_iterations,
                 bounding_box(print).largest_side(), pose);
}

Alignment align(const model::TriangleSoup& print, const model::TriangleSoup& reference_mesh, const Surface& reference,
                const AlignOptions& options) {
  const Task task{print,
                  reference,
                  options,
                  bounding_box(reference_mesh),
                  points_of(print, options.samples),
                  points_of(print, std::max(400, options.samples / 10)),
                  points_of(print, 200),
                  points_of(reference_mesh, options.samples)};
  Motion pose;
  Alignment whole = align_whole(task, pose);
  whole.overlap = overlap_of(task, pose);
  constexpr double complete = 6.0 / 7;
  if (whole.overlap >= complete) return whole;
  Alignment part = align_part(task, pose);
  part.as_part = true;
  return part;
}

}  // namespace vam::solid
