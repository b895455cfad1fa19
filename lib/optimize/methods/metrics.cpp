// SPDX-License-Identifier: GPL-3.0-or-later
#include "optimize/methods/metrics.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/index.hpp"

namespace vam::optimize {

namespace {

constexpr int lanes_per_item = 4;  // a thread reads a quarter of each cache line when it gathers single slices

/// metrics.hpp, metrics(): the figures of a grey slice.
model::DoseMetrics grey_figures(std::span<const Slab> dose, const Problem& problem, std::size_t slice) {
  const std::size_t s = slice / lanes;
  model::DoseMetrics m;
  double squares = 0;
  double outside = 0;
  double worst = -std::numeric_limits<double>::infinity();
  m.min_part = std::numeric_limits<double>::infinity();
  for (std::size_t i = slice % lanes; i < dose[s].values.size(); i += lanes) {
    if (!is_constrained(problem.labels[s][i])) continue;
    const float d = dose[s].values[i];
    const double off = std::abs(problem.demands.curve.response(d) - problem.target[s].values[i]);
    const double excess = off - problem.tolerance_at(s, i);
    const bool limited = problem.demands.void_below && problem.labels[s][i] == Label::void_;
    const double error = limited ? std::max(0.0, excess) : off;
    ++m.part;
    squares += error * error;
    outside += excess > 0 ? 1 : 0;
    worst = std::max(worst, excess);
    m.ipdr = std::max(m.ipdr, error);
    m.min_part = std::min(m.min_part, static_cast<double>(d));
    m.max_part = std::max(m.max_part, static_cast<double>(d));
    m.mean_part += d;
  }
  if (m.part == 0) return {};
  const auto count = static_cast<double>(m.part);
  m.ver = outside / count;
  m.iou = 1 - m.ver;
  m.latitude = m.pw = -worst;
  m.cv = std::sqrt(squares / count);
  m.mean_part /= count;
  m.max_dose = m.max_part;
  return m;
}

std::vector<model::DoseMetrics> grey_metrics(std::span<const Slab> dose, const Problem& problem) {
  std::vector<model::DoseMetrics> result(problem.slices);
  parallel_for(problem.slices, [&](int s) { result[s] = grey_figures(dose, problem, s); });
  return result;
}

}  // namespace

PerSlice maxima(std::span<const Slab> images, const Problem& problem) {
  return reduce(
      images, 0.0F,
      [&](float& a, std::size_t s, std::size_t i) {
        a = std::max(a, problem.labels[s][i] == Label::outside ? 0.0F : images[s].values[i]);
      },
      larger);
}

PerSlice sums(std::span<const Slab> images, const Problem& problem) {
  return summed(images, [&](std::size_t s, std::size_t i) {
    return problem.labels[s][i] == Label::outside ? 0.0F : images[s].values[i];
  });
}

namespace {

/// As label(s, i) counts the voxels.
template <class LabelOf>
std::vector<model::DoseStatistics> counted(std::span<const Slab> dose, const Problem& problem, LabelOf label,
                                           std::optional<double> threshold = std::nullopt) {
  std::vector<model::DoseStatistics> slices;
  for (int k = 0; k < problem.slices; ++k) slices.emplace_back(threshold);
  const int items = (problem.slices + lanes_per_item - 1) / lanes_per_item;
  parallel_for(items, [&](int item) {
    const int first = item * lanes_per_item;
    const int used = std::min(lanes_per_item, problem.slices - first);
    const auto s = static_cast<std::size_t>(first / lanes);
    const auto offset = static_cast<std::size_t>(first % lanes);
    for (std::size_t i = offset; i < dose[s].values.size(); i += lanes) {
      for (std::size_t lane = 0; lane < static_cast<std::size_t>(used); ++lane) {
        slices[first + lane].add(dose[s].values[i + lane], label(s, i + lane));
      }
    }
  });
  return slices;
}

}  // namespace

std::vector<model::DoseStatistics> statistics(std::span<const Slab> dose, const Problem& problem) {
  return counted(dose, problem, [&](std::size_t s, std::size_t i) { return problem.labels[s][i]; });
}

namespace {

/// Whether only resolve_thin_slices() made this voxel part.
bool is_thin_part(const Problem& problem, std::size_t s, std::size_t i) {
  return problem.labels[s][i] == Label::part && problem.is_thin(s, i);
}

/// As the target has it, before a thin slice was scaled: by a factor and back, hence the margin.
float coverage(const Problem& problem, std::size_t s, std::size_t i) {
  constexpr float rounding = 1 + 1e-6F;
  const float value = problem.target[s].values[i];
  return problem.is_thin(s, i) && value > 0 ? rounding * value / problem.gain[s * lanes + i % lanes] : value;
}

}  // namespace

std::vector<model::DoseStatistics> whole_statistics(std::span<const Slab> dose, const Problem& problem,
                                                    std::optional<double> threshold) {
  const auto label = [&](std::size_t s, std::size_t i) {
    return is_thin_part(problem, s, i) ? Label::surface : problem.labels[s][i];
  };
  return counted(dose, problem, label, threshold);
}

std::vector<model::DoseStatistics> cut_statistics(std::span<const Slab> dose, const Problem& problem) {
  return counted(dose, problem, [&](std::size_t s, std::size_t i) {
    if (problem.labels[s][i] != Label::surface && !is_thin_part(problem, s, i)) return Label::outside;
    return model::half_covered(coverage(problem, s, i)) ? Label::part : Label::void_;
  });
}

std::vector<model::DoseMetrics> metrics(std::span<const Slab> dose, const Problem& problem) {
  if (problem.demands.grey) return grey_metrics(dose, problem);
  const auto slices = statistics(dose, problem);
  std::vector<model::DoseMetrics> result(slices.size());
  parallel_for(count_of(slices), [&](int s) { result[s] = slices[s].metrics(); });
  return result;
}

namespace {

/// 0 without part.
float threshold_factor(const model::DoseMetrics& m, const DoseWindow& window) {
  if (m.part == 0 || m.iou_threshold <= 0) return 0;
  double f = window.threshold() / m.iou_threshold;
  if (m.max_void < m.min_part) f = std::min(f, window.high / m.min_part);
  return static_cast<float>(f);
}

}  // namespace

PerSlice to_common_threshold(const std::vector<model::DoseMetrics>& slices, const Problem& problem) {
  if (problem.demands.grey) return filled(problem.target.size(), 1.0F);
  PerSlice factor = filled(problem.target.size(), 0.0F);
  for (std::size_t s = 0; s < slices.size(); ++s) {
    factor[s / lanes][s % lanes] = threshold_factor(slices[s], problem.demands.window);
  }
  return factor;
}

PerSlice to_shared_threshold(std::span<const Slab> dose, const Problem& problem) {
  if (problem.demands.grey) return filled(problem.target.size(), 1.0F);
  return filled(problem.target.size(), threshold_factor(body_metrics(dose, problem), problem.demands.window));
}

model::DoseMetrics body_metrics(std::span<const Slab> dose, const Problem& problem) {
  if (problem.demands.grey) {
    model::DoseMetrics body;
    for (const auto& slice : grey_metrics(dose, problem)) {
      if (slice.part == 0) continue;
      const double before = static_cast<double>(body.part) / static_cast<double>(body.part + slice.part);
      const auto mean = [&](double a, double b) { return before * a + (1 - before) * b; };
      body.latitude = body.pw = body.part == 0 ? slice.pw : std::min(body.pw, slice.pw);
      body.ver = mean(body.ver, slice.ver);
      body.iou = 1 - body.ver;
      body.cv = std::sqrt(mean(body.cv * body.cv, slice.cv * slice.cv));
      body.ipdr = std::max(body.ipdr, slice.ipdr);
      body.part += slice.part;
    }
    return body;
  }
  model::DoseStatistics all;
  for (const auto& slice : statistics(dose, problem)) all.merge(slice);
  return all.metrics();
}

}  // namespace vam::optimize
