// SPDX-License-Identifier: GPL-3.0-or-later
#include "metrology/compare/uncertainty.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>

#include "base/compute/parallel.hpp"
#include "base/index.hpp"
#include "base/log/progress.hpp"
#include "base/random.hpp"
#include "base/text/json.hpp"
#include "solid/mesh/pose_response.hpp"
#include "solid/mesh/surface_samples.hpp"

namespace vam::metrology {

namespace {

constexpr int trials = 20;
constexpr std::size_t stride = 4;  // of the points that a trial measures
constexpr double coverage = 2;

double normal_number(std::uint64_t seed) {
  const double radius = std::sqrt(-2 * std::log(1 - unit_interval(scrambled(seed))));
  return radius * std::cos(2 * std::numbers::pi * unit_interval(scrambled(seed + 1)));
}

/// Errors of a triangle's vertices at a point in it, interpolated linearly.
struct Shares {
  std::array<int, 3> vertex{};
  std::array<double, 3> mm{};
};

Shares shares_of(const solid::SurfaceSample& place, const model::TriangleSoup& mesh, const SurfaceErrors& errors) {
  Shares shares{mesh.triangles[place.triangle], {}};
  double area = 0;
  for (std::size_t n = 0; n < 3; ++n) {
    const Vector3 next = mesh.points[shares.vertex[(n + 1) % 3]] - place.point;
    const Vector3 last = mesh.points[shares.vertex[(n + 2) % 3]] - place.point;
    shares.mm[n] = length(cross(next, last));
    area += shares.mm[n];
  }
  for (std::size_t n = 0; n < 3; ++n) {
    shares.mm[n] *= static_cast<double>(errors.vertex_mm[shares.vertex[n]]) / std::max(area, 1e-300);
  }
  return shares;
}

/// The errors of one trial.
class Draw {
 public:
  Draw(const SurfaceErrors& errors, double rms_mm, int trial)
      : cell_mm_(std::numbers::sqrt2 * errors.cell_mm),
        rms_mm_(rms_mm),
        seed_(scrambled(static_cast<std::uint64_t>(trial) << 40U)) {
    common_mm_ = errors.common_mm * normal_number(seed_ + 2) + errors.resolution_mm * normal_number(seed_ + 6);
    scale_ = errors.scale * normal_number(seed_ + 4);
  }
  /// At a place of the print.
  [[nodiscard]] double at(const solid::SurfaceSample& place, const Shares& shares) const {
    double sum = common(place);
    for (std::size_t n = 0; n < 3; ++n) {
      if (shares.mm[n] != 0) sum += shares.mm[n] * normal_number(scrambled(seed_ ^ (0xA5U + 2U * shares.vertex[n])));
    }
    return sum;
  }
  /// At a place of the design, which knows of no vertices of the print: by cells that scatter as much.
  [[nodiscard]] double at(const solid::SurfaceSample& place) const {
    std::uint64_t cell = seed_;
    for (const double x : place.point) {
      cell = scrambled(cell ^ static_cast<std::uint64_t>(std::llround(x / cell_mm_)));
    }
    return rms_mm_ * normal_number(cell) + common(place);
  }

 private:
  [[nodiscard]] double common(const solid::SurfaceSample& place) const {
    return common_mm_ + scale_ * dot(place.point, place.normal);
  }

  double cell_mm_;
  double rms_mm_;  // at points between the vertices
  std::uint64_t seed_;
  double common_mm_ = 0;
  double scale_ = 0;
};

template <class Item>
std::vector<Item> every(const std::vector<Item>& all, std::size_t first) {
  std::vector<Item> some;
  for (std::size_t i = first; i < all.size(); i += stride) some.push_back(all[i]);
  return some;
}

/// Indices of the points that every() leaves, among those.
void thin(std::vector<std::size_t>& indices, std::size_t first) {
  std::erase_if(indices, [&](std::size_t i) { return i % stride != first; });
  for (std::size_t& i : indices) i /= stride;
}

/// A region's points among those that every() leaves.
void thin(RegionPoints& region, std::size_t first) {
  const auto keep = [first](const std::vector<std::size_t>& indices, auto& values) {
    auto kept = values.begin();
    for (std::size_t n = 0; n < values.size(); ++n) {
      if (indices[n] % stride == first) *kept++ = values[n];
    }
    values.erase(kept, values.end());
  };
  keep(region.print, region.print_normals);
  keep(region.design, region.opposite);
  keep(region.design, region.opposite_mm);
  thin(region.print, first);
  thin(region.design, first);
}

/// A quarter of the points.
Inspection part_of(const Inspection& whole, std::size_t first) {
  Inspection part{{every(whole.distances.on_print, first), every(whole.distances.print_mm, first),
                   every(whole.distances.on_design, first), every(whole.distances.design_mm, first),
                   whole.distances.largest_dimension_mm},
                  {},
                  whole.regions,
                  whole.tolerance_mm,
                  whole.pose};
  for (RegionPoints& region : part.regions) thin(region, first);
  return part;
}

/// All distances of an inspection in one trial.
struct TrialErrors {
  std::vector<double> print_mm;
  std::vector<double> design_mm;
  std::vector<std::vector<double>> opposite_mm;  // of each region
  double growth = 0;                             // of the fitted scale
};

class Trials {
 public:
  Trials(const Inspection& part, const model::TriangleSoup& print, const SurfaceErrors& errors)
      : part_(part), errors_(errors) {
    double sum = 0;
    for (const auto& place : part.distances.on_print) {
      shares_.push_back(shares_of(place, print, errors));
      for (const double mm : shares_.back().mm) sum += mm * mm;
    }
    rms_mm_ = std::sqrt(sum / static_cast<double>(shares_.size()));
    if (part.pose.aligned) choose_pose_points();
  }

  [[nodiscard]] Json run(int trial) const {
    const TrialErrors by = errors_of(trial);
    Distances moved = part_.distances;
    for (std::size_t i = 0; i < moved.print_mm.size(); ++i) moved.print_mm[i] += static_cast<float>(by.print_mm[i]);
    for (std::size_t i = 0; i < moved.design_mm.size(); ++i) moved.design_mm[i] += static_cast<float>(by.design_mm[i]);
    Json json = to_json(compare(moved));
    if (part_.tolerance_mm) json["within_percent"] = within_percent(moved.print_mm, *part_.tolerance_mm);
    if (part_.pose.with_scale) {
      json["alignment"]["shrinkage_percent"] = part_.pose.shrinkage_percent + 100 * by.growth;
    }
    for (std::size_t r = 0; r < part_.regions.size(); ++r) {
      const RegionErrors errors{by.print_mm, by.design_mm, by.opposite_mm[r]};
      json["regions"][part_.regions[r].region.name] = region_json(part_.regions[r], part_.distances, errors);
    }
    return json;
  }

 private:
  void choose_pose_points() {
    constexpr std::size_t most = 20000;
    const auto& datum = part_.pose.datum;
    for (const RegionPoints& region : part_.regions) {
      if (std::find(datum.begin(), datum.end(), region.region.name) == datum.end()) continue;
      pose_points_.insert(pose_points_.end(), region.print.begin(), region.print.end());
    }
    const std::size_t step = std::max<std::size_t>(1, part_.distances.on_print.size() / most);
    for (std::size_t i = 0; datum.empty() && i < part_.distances.on_print.size(); i += step) pose_points_.push_back(i);
    std::vector<solid::SurfaceSample> places;
    for (const std::size_t i : pose_points_) places.push_back(part_.distances.on_print[i]);
    pose_.emplace(places, part_.pose.with_scale);
  }

  [[nodiscard]] TrialErrors errors_of(int trial) const {
    const Draw draw(errors_, rms_mm_, trial);
    TrialErrors by;
    const auto& on_print = part_.distances.on_print;
    for (std::size_t i = 0; i < on_print.size(); ++i) by.print_mm.push_back(draw.at(on_print[i], shares_[i]));
    solid::PoseResponse::Motion motion{};
    if (pose_) {
      std::vector<double> at_points;
      for (const std::size_t i : pose_points_) at_points.push_back(by.print_mm[i]);
      motion = pose_->of(at_points);
      by.growth = motion[6];
    }
    const auto pulled = [&](const solid::SurfaceSample& place) { return pose_ ? pose_->at(motion, place) : 0.0; };
    for (std::size_t i = 0; i < on_print.size(); ++i) by.print_mm[i] += pulled(on_print[i]);
    for (const auto& place : part_.distances.on_design) by.design_mm.push_back(draw.at(place) + pulled(place));
    for (const RegionPoints& region : part_.regions) {
      auto& opposite = by.opposite_mm.emplace_back();
      for (const auto& place : region.opposite) opposite.push_back(draw.at(place) + pulled(place));
    }
    return by;
  }

  const Inspection& part_;
  const SurfaceErrors& errors_;
  std::vector<Shares> shares_;  // of on_print
  double rms_mm_ = 0;
  std::vector<std::size_t> pose_points_;
  std::optional<solid::PoseResponse> pose_;
};

/// Whether the figure of this name is an extreme. The noise of the print is in an extreme already; the same noise again
/// moves it by sqrt(2) - 1 of what it did.
bool is_extreme(const std::string& name) {
  constexpr std::array<const char*, 5> names{"min", "max", "hausdorff", "flatness", "cylindricity"};
  return std::any_of(names.begin(), names.end(), [&](const char* prefix) { return name.starts_with(prefix); });
}
/// Counts, and what is of the design alone.
bool is_exact(const std::string& name) {
  return name == "samples" || name == "largest_dimension_mm" || name.starts_with("design_");
}

/// Contribution of the least certain places to an extreme: in mm, and in % of the largest dimension.
struct Places {
  double mm, percent;
};

/// Twice the combined standard deviation and mean departure of the trials from a number.
double expanded_number(const std::string& key, double figure, const std::vector<const Json*>& tried,
                       const Places& worst) {
  const auto n = static_cast<double>(tried.size());
  double mean = 0;
  for (const Json* one : tried) mean += (one->get<double>() - figure) / n;
  double squares = 0;
  for (const Json* one : tried) squares += std::pow(one->get<double>() - figure - mean, 2) / n;
  if (!is_extreme(key)) return coverage * std::hypot(std::sqrt(squares), mean);
  return coverage * std::hypot(std::sqrt(squares), mean / (std::numbers::sqrt2 - 1),
                               key.ends_with("_percent") ? worst.percent : worst.mm);
}

/// Objects and lists in their own shape.
Json expanded(const std::string& name, const Json& figures, const std::vector<const Json*>& tried,
              const Places& worst) {
  if (tried.front()->is_number()) return expanded_number(name, figures.get<double>(), tried, worst);
  Json out;
  const auto add = [&](const auto& key, const std::string& inner_name, Json& place) {
    std::vector<const Json*> inner;
    for (const Json* one : tried) inner.push_back(&one->at(key));
    place = expanded(inner_name, figures.at(key), inner, worst);
  };
  if (tried.front()->is_array()) {
    for (std::size_t i = 0; i < tried.front()->size(); ++i) add(i, name, out.emplace_back());
    return out;
  }
  for (const auto& [key, value] : tried.front()->items()) {
    if (!is_exact(key) || value.is_object()) add(key, key, out[key]);
  }
  return out;
}

}  // namespace

Json to_json(const SurfaceErrors& errors) {
  double sum = 0;
  for (const float u : errors.vertex_mm) sum += std::pow(static_cast<double>(u), 2);
  return {{"source", errors.source},
          {"surface_mm", std::sqrt(sum / static_cast<double>(std::max<std::size_t>(1, errors.vertex_mm.size())))},
          {"cell_mm", errors.cell_mm},
          {"isovalue_mm", errors.common_mm},
          {"resolution_mm", errors.resolution_mm},
          {"extreme_mm", errors.extreme_mm},
          {"scale_percent", 100 * errors.scale},
          {"coverage_factor", coverage},
          {"trials", trials}};
}

Json expanded_uncertainty(const Inspection& inspection, const model::TriangleSoup& print, const SurfaceErrors& errors) {
  std::vector<Json> tried(trials);
  std::vector<Inspection> parts;
  for (std::size_t first = 0; first < stride; ++first) parts.push_back(part_of(inspection, first));
  std::vector<Trials> made;
  for (const Inspection& part : parts) made.emplace_back(part, print, errors);
  Progress progress("estimating uncertainties", trials);
  parallel_for(trials, [&](int trial) {
    tried[trial] = made[static_cast<std::size_t>(trial) % stride].run(trial);
    progress.tick();
  });
  std::vector<const Json*> all;
  for (const Json& one : tried) all.push_back(&one);
  return expanded("", figures_json(inspection), all,
                  {errors.extreme_mm, 100 * errors.extreme_mm / inspection.distances.largest_dimension_mm});
}

}  // namespace vam::metrology
