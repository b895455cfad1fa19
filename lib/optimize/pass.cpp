#include "optimize/pass.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

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

constexpr auto larger = [](float& a, float b) { a = std::max(a, b); };

}  // namespace

std::vector<Slab> slabs(std::size_t count, int width, int height) {
  return std::vector<Slab>(count, Slab(width, height));
}

Problem make_problem(const float* slices, int count, int width, int height, const Circle& circle,
                     const Window& window) {
  Problem problem{.slices = count, .target = {}, .labels = {}, .window = window};
  const std::size_t pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  for (int first = 0; first < count; first += lanes) {
    const int used = std::min(lanes, count - first);
    Slab slab(width, height);
    tomo::pack(slices + static_cast<std::size_t>(first) * pixels, used, slab);
    std::vector<Label> labels(slab.values.size(), Label::outside);
    parallel_for(height, [&](int y) {
      for (int x = 0; x < width; ++x) {
        const auto at = static_cast<std::size_t>(slab.at(x, y) - slab.values.data());
        if (!circle.contains(x, y)) {
          std::fill_n(slab.at(x, y), lanes, 0.0F);
          continue;
        }
        for (std::size_t lane = 0; lane < static_cast<std::size_t>(used); ++lane) {
          labels[at + lane] = model::label_of(slab.values[at + lane]);
        }
      }
    });
    parallel_for(used, [&](int lane) { settle_thin(slab, static_cast<std::size_t>(lane), labels); });
    problem.target.push_back(std::move(slab));
    problem.labels.push_back(std::move(labels));
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
    const float d = slope(dose[s].values[i], problem.labels[s][i], problem.window);
    return 0.5F * d * d;
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
      for (int lane = 0; lane < used; ++lane) {
        slices[static_cast<std::size_t>(first + lane)].add(values[i + static_cast<std::size_t>(lane)],
                                                           labels[i + static_cast<std::size_t>(lane)]);
      }
    }
  });
  return slices;
}

std::vector<model::DoseMetrics> metrics(std::span<const Slab> dose, const Problem& problem) {
  const auto slices = statistics(dose, problem);
  std::vector<model::DoseMetrics> result(slices.size());
  parallel_for(static_cast<int>(slices.size()),
               [&](int s) { result[static_cast<std::size_t>(s)] = slices[static_cast<std::size_t>(s)].metrics(); });
  return result;
}

PerSlice to_common_threshold(const std::vector<model::DoseMetrics>& slices, const Problem& problem) {
  PerSlice factor(problem.target.size());
  for (auto& lane : factor) lane.fill(0.0F);
  for (std::size_t s = 0; s < slices.size(); ++s) {
    const auto& m = slices[s];
    if (m.part == 0 || m.iou_threshold <= 0) continue;
    double f = problem.window.threshold() / m.iou_threshold;
    if (m.max_void < m.min_part) f = std::min(f, problem.window.high / m.min_part);
    factor[s / lanes][s % lanes] = static_cast<float>(f);
  }
  return factor;
}

}  // namespace vam::optimize
