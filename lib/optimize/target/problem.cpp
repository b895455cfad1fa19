// SPDX-License-Identifier: GPL-3.0-or-later
#include "optimize/target/problem.hpp"

#include <algorithm>
#include <array>

#include "base/error.hpp"
#include "base/text/text.hpp"

namespace vam::optimize {

namespace {

bool has_part(const std::vector<Label>& labels, std::size_t lane) {
  for (std::size_t i = lane; i < labels.size(); i += lanes) {
    if (labels[i] == Label::part) return true;
  }
  return false;
}

void resolve_thin_slice(Problem& problem, int slice) {
  constexpr float half = 0.5F;
  const auto s = static_cast<std::size_t>(slice / lanes);
  const auto lane = static_cast<std::size_t>(slice % lanes);
  Slab& slab = problem.target[s];
  std::vector<Label>& labels = problem.labels[s];
  float most = 0;
  for (std::size_t i = lane; i < labels.size(); i += lanes) most = std::max(most, slab.values[i]);
  const float gain = most >= half ? 1.0F / most : 0.0F;
  problem.gain[slice] = gain;
  for (std::size_t i = lane; i < labels.size(); i += lanes) {
    slab.values[i] *= gain;
    const bool counts = s >= problem.weight.size() || problem.weight[s].values[i] > 0;
    if (counts && labels[i] == Label::surface && slab.values[i] >= half) labels[i] = Label::part;
  }
}

Label label_of(float value, const Demands& demands) {
  const Label label = model::label_of(value);
  if (demands.grey) return label == Label::surface ? Label::part : label;
  if (demands.surface && label == Label::surface) return model::half_covered(value) ? Label::part : Label::void_;
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
  return labels;
}

/// Weights relative to the slice's largest; voxels of weight 0 are unconstrained.
void free_weightless(Slab& weight, std::vector<Label>& labels) {
  std::array<float, lanes> most{};
  for (std::size_t i = 0; i < labels.size(); ++i) {
    if (is_constrained(labels[i])) most[i % lanes] = std::max(most[i % lanes], weight.values[i]);
  }
  for (std::size_t i = 0; i < labels.size(); ++i) {
    float& w = weight.values[i];
    w = most[i % lanes] > 0 ? w / most[i % lanes] : 0.0F;
    if (w <= 0 && is_constrained(labels[i])) labels[i] = Label::surface;
  }
}

/// From slice `first` on.
void resolve_thin_slices(Problem& problem, int first) {
  if (problem.demands.grey) return;
  std::vector<char> whole(static_cast<std::size_t>(problem.slices) + 1, 0);
  parallel_for(problem.slices - first, [&](int n) {
    const int k = first + n;
    whole[k] = has_part(problem.labels[k / lanes], k % lanes) ? 1 : 0;
  });
  const bool ends_are_known = problem.stacked && asks_surface(problem.demands);
  parallel_for(problem.slices - first, [&](int n) {
    const int k = first + n;
    const bool is_end = ends_are_known && (whole[k + 1] != 0 || (k > 0 && whole[k - 1] != 0));
    if (whole[k] != 0 || is_end) return;
    resolve_thin_slice(problem, k);
  });
}

}  // namespace

void resolve_thin_slices(Problem& problem) { resolve_thin_slices(problem, 0); }

void add_delivered(const Problem& problem, std::span<Slab> dose) {
  if (problem.delivered.empty()) return;
  for_values(dose, [&](std::size_t s, std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) dose[s].values[i] += problem.delivered[s].values[i];
  });
}

void check(const Demands& demands) {
  const DoseWindow& w = demands.window;
  if (w.low >= 0 && w.low < w.high) return;
  throw Error{Fault::usage, "the largest void dose, " + format_number(w.low) + ", is not below the least part dose, " +
                                format_number(w.high)};
}

void append(Problem& problem, const Slices& slices, int count, int width, int height, const Circle& circle) {
  const auto packed = [&](const float* images) {
    Slab slab(width, height);
    pack(images, count, slab);
    return slab;
  };
  problem.slices += count;
  problem.gain.resize(problem.slices, 1.0F);
  problem.target.push_back(packed(slices.target));
  problem.labels.push_back(labelled(problem.target.back(), count, circle, problem.demands));
  if (!problem.stacked) resolve_thin_slices(problem, problem.slices - count);
  if (slices.weight != nullptr) {
    problem.weight.push_back(packed(slices.weight));
    free_weightless(problem.weight.back(), problem.labels.back());
  }
  if (slices.tolerance != nullptr) problem.tolerance.push_back(packed(slices.tolerance));
  if (slices.delivered != nullptr) problem.delivered.push_back(packed(slices.delivered));
}

}  // namespace vam::optimize
