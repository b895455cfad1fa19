#include "optimize/pass.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.hpp"
#include "base/text.hpp"
#include "optimize/loss.hpp"

namespace vam::optimize {

namespace {

constexpr int lanes_per_item = 4;  // a thread reads a quarter of each cache line when it gathers single slices

/// Reduces the rows of each slab: fold(accumulator of 16 lanes, slab, first, last), then merges rows in order.
template <class Fold, class Merge>
PerSlice reduce(std::span<const Slab> images, float start, const Fold& fold, const Merge& merge) {
  PerSlice result(images.size());
  for (auto& lane : result) lane.fill(start);
  if (images.empty()) return result;
  const auto rows = static_cast<std::size_t>(images[0].height);
  const std::size_t row = static_cast<std::size_t>(images[0].width) * lanes;
  std::vector<std::array<float, lanes>> partial(images.size() * rows);
  for_values(images, [&](std::size_t s, std::size_t first, std::size_t last) {
    std::array<float, lanes> sum{};
    sum.fill(start);
    for (std::size_t i = first; i < last; i += lanes) {
      for (std::size_t lane = 0; lane < lanes; ++lane) fold(sum[lane], s, i + lane);
    }
    partial[s * rows + first / row] = sum;
  });
  for (std::size_t i = 0; i < partial.size(); ++i) {
    for (std::size_t lane = 0; lane < lanes; ++lane) merge(result[i / rows][lane], partial[i][lane]);
  }
  return result;
}

/// A slice without a whole part voxel, such as a thin wall's or one that the part's flat end cuts.
void settle_thin(Slab& slab, std::size_t lane, std::vector<Label>& labels) {
  constexpr float half = 0.5F;
  float most = 0;
  for (std::size_t i = lane; i < labels.size(); i += lanes) {
    if (labels[i] == Label::part) return;
    most = std::max(most, slab.values[i]);
  }
  const float gain = most >= half ? 1.0F / most : 0.0F;
  for (std::size_t i = lane; i < labels.size(); i += lanes) {
    slab.values[i] *= gain;
    if (labels[i] == Label::surface && slab.values[i] >= half) labels[i] = Label::part;
  }
}

Label label_of(float value, const Demands& demands) {
  const Label label = model::label_of(value);
  if (demands.grey) return label == Label::surface ? Label::part : label;
  if (demands.surface && label == Label::surface) return value >= 0.5F ? Label::part : Label::void_;
  return label;
}

/// The labels of a slab, whose values outside the circle become 0.
std::vector<Label> labelled(Slab& slab, int used, const Circle& circle, const Demands& demands) {
  std::vector<Label> labels(slab.values.size(), Label::outside);
  parallel_for(slab.height, [&](int y) {
    for (int x = 0; x < slab.width; ++x) {
      const auto at = static_cast<std::size_t>(slab.at(x, y) - slab.values.data());
      if (!circle.contains(x, y)) {
        std::fill_n(slab.at(x, y), lanes, 0.0F);
        continue;
      }
      for (std::size_t lane = 0; lane < static_cast<std::size_t>(used); ++lane) {
        labels[at + lane] = label_of(slab.values[at + lane], demands);
      }
    }
  });
  if (!demands.grey) {
    parallel_for(used, [&](int lane) { settle_thin(slab, static_cast<std::size_t>(lane), labels); });
  }
  return labels;
}

/// Weights relative to the slice's largest; voxels without any are asked for nothing.
void free_weightless(Slab& weight, std::vector<Label>& labels) {
  std::array<float, lanes> most{};
  for (std::size_t i = 0; i < labels.size(); ++i) {
    if (asked(labels[i])) most[i % lanes] = std::max(most[i % lanes], weight.values[i]);
  }
  for (std::size_t i = 0; i < labels.size(); ++i) {
    float& w = weight.values[i];
    w = most[i % lanes] > 0 ? w / most[i % lanes] : 0.0F;
    if (w <= 0 && asked(labels[i])) labels[i] = Label::surface;
  }
}

constexpr auto larger = [](float& a, float b) { a = std::max(a, b); };

/// pass.hpp, metrics(): the figures of a grey slice.
model::DoseMetrics grey_figures(std::span<const Slab> dose, const Problem& problem, std::size_t slice) {
  const std::size_t s = slice / lanes;
  model::DoseMetrics m;
  double squares = 0;
  double outside = 0;
  double worst = -std::numeric_limits<double>::infinity();
  m.min_part = std::numeric_limits<double>::infinity();
  for (std::size_t i = slice % lanes; i < dose[s].values.size(); i += lanes) {
    if (!asked(problem.labels[s][i])) continue;
    const float d = dose[s].values[i];
    const auto error = static_cast<double>(std::abs(problem.demands.curve.response(d) - problem.target[s].values[i]));
    const double excess = error - static_cast<double>(problem.tolerance_at(s, i));
    ++m.part;
    squares += error * error;
    outside += excess > 0 ? 1 : 0;
    worst = std::max(worst, excess);
    m.ipdr = std::max(m.ipdr, error);
    m.min_part = std::min(m.min_part, static_cast<double>(d));
    m.max_part = std::max(m.max_part, static_cast<double>(d));
    m.mean_part += static_cast<double>(d);
  }
  if (m.part == 0) return {};
  const auto count = static_cast<double>(m.part);
  m.ver = outside / count;
  m.iou = 1 - m.ver;
  m.pw = -worst;
  m.cv = std::sqrt(squares / count);
  m.mean_part /= count;
  m.max_dose = m.max_part;
  return m;
}

std::vector<model::DoseMetrics> grey_metrics(std::span<const Slab> dose, const Problem& problem) {
  std::vector<model::DoseMetrics> result(static_cast<std::size_t>(problem.slices));
  parallel_for(problem.slices, [&](int s) {
    result[static_cast<std::size_t>(s)] = grey_figures(dose, problem, static_cast<std::size_t>(s));
  });
  return result;
}

}  // namespace

std::vector<Slab> slabs(std::size_t count, int width, int height) {
  return std::vector<Slab>(count, Slab(width, height));
}

void check(const Demands& demands) {
  const Window& w = demands.window;
  if (w.low >= 0 && w.low < w.high) return;
  throw Error{Fault::usage, "--dose-low " + format_number(w.low) + " is not below --dose-high " +
                                format_number(w.high) + "; the void's limit must lie below the part's"};
}

void append(Problem& problem, const Slices& slices, int count, int width, int height, const Circle& circle) {
  const auto packed = [&](const float* images) {
    Slab slab(width, height);
    tomo::pack(images, count, slab);
    return slab;
  };
  problem.slices += count;
  problem.target.push_back(packed(slices.target));
  problem.labels.push_back(labelled(problem.target.back(), count, circle, problem.demands));
  if (slices.weight != nullptr) {
    problem.weight.push_back(packed(slices.weight));
    free_weightless(problem.weight.back(), problem.labels.back());
  }
  if (slices.tolerance != nullptr) problem.tolerance.push_back(packed(slices.tolerance));
}

Problem make_problem(const float* slices, int count, int width, int height, const Circle& circle,
                     const Demands& demands, const float* weight, const float* tolerance) {
  check(demands);
  Problem problem{.slices = 0, .target = {}, .labels = {}, .demands = demands, .weight = {}, .tolerance = {}};
  const auto pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  const auto from = [&](const float* images, int first) {
    return images == nullptr ? nullptr : images + static_cast<std::size_t>(first) * pixels;
  };
  for (int first = 0; first < count; first += lanes) {
    append(problem, {from(slices, first), from(weight, first), from(tolerance, first)}, std::min(lanes, count - first),
           width, height, circle);
  }
  return problem;
}

double reach(const float* slice, int width, int height, double axis_x, double axis_y) {
  double farthest = -1;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      if (*slice++ > model::coverage_rounding) farthest = std::max(farthest, std::hypot(x - axis_x, y - axis_y));
    }
  }
  return farthest;
}

PerSlice minima(std::span<const Slab> images) {
  constexpr float highest = std::numeric_limits<float>::max();
  const auto lower = [](float& a, float b) { a = std::min(a, b); };
  return reduce(
      images, highest, [&](float& a, std::size_t s, std::size_t i) { lower(a, images[s].values[i]); }, lower);
}

PerSlice largest(std::span<const Slab> images) {
  constexpr float lowest = std::numeric_limits<float>::lowest();
  return reduce(
      images, lowest, [&](float& a, std::size_t s, std::size_t i) { larger(a, images[s].values[i]); }, larger);
}

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

PerSlice loss(std::span<const Slab> dose, const Problem& problem) {
  return summed(dose, [&](std::size_t s, std::size_t i) {
    return loss(problem, problem.demands.window, s, i, dose[s].values[i]);
  });
}

PerSlice reciprocal(PerSlice values) {
  for (auto& lane : values) {
    for (float& v : lane) v = v > 0 ? 1.0F / v : 0.0F;
  }
  return values;
}

void restore(std::vector<Slab>& now, const std::vector<Slab>& before, const PerSlice& back) {
  for_values(now, [&](std::size_t s, std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      if (back[s][i % lanes] != 0.0F) now[s].values[i] = before[s].values[i];
    }
  });
}

void scale(std::span<Slab> images, const PerSlice& factor) {
  for_values(images, [&](std::size_t s, std::size_t first, std::size_t last) {
    float* v = images[s].values.data();
    const float* f = factor[s].data();
    for (std::size_t i = first; i < last; i += lanes) {
      for (std::size_t lane = 0; lane < lanes; ++lane) v[i + lane] *= f[lane];
    }
  });
}

void clip_below(std::span<Slab> images, float floor) {
  for_values(images, [&](std::size_t s, std::size_t first, std::size_t last) {
    float* v = images[s].values.data();
    for (std::size_t i = first; i < last; ++i) v[i] = v[i] > floor ? v[i] : floor;
  });
}

std::vector<model::DoseStatistics> statistics(std::span<const Slab> dose, const Problem& problem) {
  std::vector<model::DoseStatistics> slices(static_cast<std::size_t>(problem.slices));
  const int items = (problem.slices + lanes_per_item - 1) / lanes_per_item;
  parallel_for(items, [&](int item) {
    const int first = item * lanes_per_item;
    const int used = std::min(lanes_per_item, problem.slices - first);
    const auto s = static_cast<std::size_t>(first / lanes);
    const float* values = dose[s].values.data() + first % lanes;
    const Label* labels = problem.labels[s].data() + first % lanes;
    for (std::size_t i = 0; i < dose[s].values.size(); i += lanes) {
      for (std::size_t lane = 0; lane < static_cast<std::size_t>(used); ++lane) {
        slices[static_cast<std::size_t>(first) + lane].add(values[i + lane], labels[i + lane]);
      }
    }
  });
  return slices;
}

std::vector<model::DoseMetrics> metrics(std::span<const Slab> dose, const Problem& problem) {
  if (problem.demands.grey) return grey_metrics(dose, problem);
  const auto slices = statistics(dose, problem);
  std::vector<model::DoseMetrics> result(slices.size());
  parallel_for(static_cast<int>(slices.size()),
               [&](int s) { result[static_cast<std::size_t>(s)] = slices[static_cast<std::size_t>(s)].metrics(); });
  return result;
}

PerSlice to_common_threshold(const std::vector<model::DoseMetrics>& slices, const Problem& problem) {
  PerSlice factor(problem.target.size());
  for (auto& lane : factor) lane.fill(problem.demands.grey ? 1.0F : 0.0F);
  if (problem.demands.grey) return factor;
  const Window& window = problem.demands.window;
  for (std::size_t s = 0; s < slices.size(); ++s) {
    const auto& m = slices[s];
    if (m.part == 0 || m.iou_threshold <= 0) continue;
    double f = window.threshold() / m.iou_threshold;
    if (m.max_void < m.min_part) f = std::min(f, window.high / m.min_part);
    factor[s / lanes][s % lanes] = static_cast<float>(f);
  }
  return factor;
}

}  // namespace vam::optimize
