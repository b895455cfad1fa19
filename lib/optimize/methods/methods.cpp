#include "base/error.hpp"
#include "optimize/methods/method.hpp"
#include "optimize/methods/metrics.hpp"

namespace vam::optimize {

std::unique_ptr<Method> make_fbp(const MethodOptions& options);
std::unique_ptr<Method> make_dose_norm(const MethodOptions& options);
std::unique_ptr<Method> make_cal(const MethodOptions& options);
std::unique_ptr<Method> make_osmo(const MethodOptions& options);
std::unique_ptr<Method> make_pm(const MethodOptions& options);
std::unique_ptr<Method> make_bclp(const MethodOptions& options);
std::unique_ptr<Method> make_apg(const MethodOptions& options);

namespace {

struct Entry {
  std::string name;
  std::unique_ptr<Method> (*make)(const MethodOptions&);
};

const std::vector<Entry>& entries() {
  static const std::vector<Entry> all{
      {"fbp", make_fbp}, {"dose-norm", make_dose_norm}, {"cal", make_cal}, {"osmo", make_osmo},
      {"pm", make_pm},   {"bclp", make_bclp},           {"apg", make_apg}};
  return all;
}

}  // namespace

const std::vector<std::string>& method_names() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> list;
    for (const auto& entry : entries()) list.push_back(entry.name);
    return list;
  }();
  return names;
}

std::unique_ptr<Method> make_method(const std::string& name, const MethodOptions& options) {
  for (const auto& entry : entries()) {
    if (entry.name == name) return entry.make(options);
  }
  std::string known;
  for (const auto& entry : entries()) known += (known.empty() ? "" : ", ") + entry.name;
  throw Error{Fault::usage, "no method is called '" + name + "'; there are " + known};
}

void Method::start(const Problem& problem, const light::Operator& light, Iterate& iterate) {
  filtered_projections(light, problem.target, iterate.g);
  clip_below(iterate.g, 0.0F);
  Method::resume(problem, light, iterate);
}

void Method::resume(const Problem& /*problem*/, const light::Operator& light, Iterate& iterate) {
  if (iterate.dose.empty()) iterate.dose = slabs(iterate.g.size(), light.object().width, light.object().height);
  light.adjoint(iterate.g, iterate.dose);
}

void start_at_threshold(const Problem& problem, const light::Operator& light, Iterate& iterate) {
  const PerSlice factor = to_common_threshold(metrics(iterate.dose, problem), problem);
  scale(iterate.g, factor);
  if (light.couples_slices()) {
    light.adjoint(iterate.g, iterate.dose);
  } else {
    scale(iterate.dose, factor);
  }
}

void filtered_projections(const light::Operator& light, std::span<const Slab> object, std::vector<Slab>& g) {
  if (g.empty()) g = slabs(object.size(), light.sinogram().width, light.sinogram().height);
  light.invert(object, g);
}

}  // namespace vam::optimize
