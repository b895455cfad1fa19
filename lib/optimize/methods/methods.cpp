// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>

#include "base/error.hpp"
#include "base/text/text.hpp"
#include "optimize/methods/method.hpp"
#include "optimize/methods/metrics.hpp"
#include "optimize/methods/private/safeguard.hpp"

namespace vam::optimize {

MethodEntry fbp_method();
MethodEntry dose_norm_method();
MethodEntry cal_method();
MethodEntry osmo_method();
MethodEntry pm_method();
MethodEntry bclp_method();
MethodEntry apg_method();
MethodEntry minimax_method();

const std::vector<MethodEntry>& method_table() {
  static const std::vector<MethodEntry> all{
      fbp_method(), dose_norm_method(), cal_method(), osmo_method(),
      pm_method(),  bclp_method(),      apg_method(), minimax_method(),
  };
  return all;
}

const MethodEntry& method_entry(const std::string& name) {
  for (const auto& entry : method_table()) {
    if (entry.name == name) return entry;
  }
  throw Error{Fault::usage, "no method is called '" + name + "'; there are " + join(method_names(), ", ")};
}

bool reads(const MethodEntry& method, const std::string& option) {
  return std::find(method.options.begin(), method.options.end(), option) != method.options.end();
}

std::unique_ptr<Method> make_method(const std::string& name, const MethodOptions& options) {
  return method_entry(name).make(options);
}

std::vector<std::string> method_names() {
  return method_names([](const MethodEntry&) { return true; });
}

std::vector<std::string> method_names(const std::function<bool(const MethodEntry&)>& holds) {
  std::vector<std::string> names;
  for (const auto& entry : method_table()) {
    if (holds(entry)) names.push_back(entry.name);
  }
  return names;
}

namespace {

/// Scales light by the larger of two factors: the share of the dose that is left, 1 - <D, A* g> / <A* g, A* g> over the
/// part, for light of the whole dose; and <T - D, A* g> / <A* g, A* g>, by which light of the rest reaches the least
/// dose of the part.
void leave_rest(const Problem& problem, const light::Operator& light, Iterate& iterate) {
  iterate.dose = slabs(iterate.g.size(), light.object().width, light.object().height);
  light.adjoint(iterate.g, iterate.dose);
  const auto product = [&](const std::vector<Slab>& other) {
    return pooled(summed(iterate.dose,
                         [&](std::size_t s, std::size_t i) {
                           const bool counts = problem.labels[s][i] == Label::part;
                           return counts ? other[s].values[i] * iterate.dose[s].values[i] : 0.0F;
                         }),
                  light);
  };
  const PerSlice given = product(problem.delivered);
  const PerSlice all = pooled(summed(iterate.dose,
                                     [&](std::size_t s, std::size_t i) {
                                       const bool counts = problem.labels[s][i] == Label::part;
                                       return counts ? iterate.dose[s].values[i] : 0.0F;
                                     }),
                              light);
  const auto least = static_cast<float>(problem.demands.window.high);
  PerSlice rest = product(iterate.dose);
  for_slices(rest, [&](std::size_t s, std::size_t lane) {
    float& share = rest[s][lane];
    const float given_here = given[s][lane];
    share = share > 0 ? std::max({0.0F, 1 - given_here / share, (least * all[s][lane] - given_here) / share}) : 1;
  });
  scale(iterate.g, rest);
}

}  // namespace

void Method::start(const Problem& problem, const light::Operator& light, Iterate& iterate) {
  filtered_projections(light, problem.target, iterate.g);
  clip_below(iterate.g, 0.0F);
  find_dose(problem, light, iterate);
}

void Method::resume(const Problem& problem, const light::Operator& light, Iterate& iterate) {
  if (!problem.delivered.empty()) leave_rest(problem, light, iterate);
  clip_above(iterate.g, largest_light(options_, light));
  find_dose(problem, light, iterate);
}

void find_dose(const Problem& problem, const light::Operator& light, Iterate& iterate) {
  if (iterate.dose.empty()) iterate.dose = slabs(iterate.g.size(), light.object().width, light.object().height);
  light.adjoint(iterate.g, iterate.dose);
  add_delivered(problem, iterate.dose);
}

void start_at_threshold(const Problem& problem, const light::Operator& light, Iterate& iterate) {
  const PerSlice factor = light.couples_slices() ? to_shared_threshold(iterate.dose, problem)
                                                 : to_common_threshold(metrics(iterate.dose, problem), problem);
  scale(iterate.g, factor);
  scale(iterate.dose, factor);
}

void filtered_projections(const light::Operator& light, std::span<const Slab> object, std::vector<Slab>& g) {
  if (g.empty()) g = slabs(object.size(), light.sinogram().width, light.sinogram().height);
  light.invert(object, g);
}

}  // namespace vam::optimize
