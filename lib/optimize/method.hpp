// What every optimiser has in common. A method is one file that implements Method and one line in methods.cpp.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "optimize/operator.hpp"
#include "optimize/pass.hpp"

namespace vam::optimize {

/// Projections and the dose they give. Methods keep the two in step, so that looking at an iterate costs nothing.
struct Iterate {
  std::vector<Slab> g;     // sinograms
  std::vector<Slab> dose;  // A* g
};

/// Defaults are the ones the manual shows. A method reads those it needs.
struct MethodOptions {
  Window window;
  double background = 0.5;   // dose-norm: B, 0...1
  double floor = 0;          // fbp, dose-norm: projections are not let below it (fluence)
  bool offset = false;       // fbp: raise all projections by the lowest value instead of clipping
  bool thresholding = true;  // cal: the sigmoid inside the loop
  double softness = 0.05;    // cal: gamma of the sigmoid, in units of the largest dose
  double step = 0.5;         // cal: lambda
  double peak = 0;           // largest fluence, 0 = any: apg, pm, bclp
  double power = 2;          // pm, bclp: p of the norm, at least 1
  double band = 0.1;         // bclp: epsilon, how far the response may be from the target
};

class Method {
 public:
  explicit Method(const MethodOptions& options) : options_(options) {}
  virtual ~Method() = default;
  Method(const Method&) = delete;
  Method& operator=(const Method&) = delete;

  /// First iterate, from nothing. The default is clipped filtered back-projection.
  virtual void start(const Problem& problem, const Operator& light, Iterate& iterate);
  /// First iterate, from given projections iterate.g. The default computes their dose.
  virtual void resume(const Problem& problem, const Operator& light, Iterate& iterate);
  /// One iteration.
  virtual void step(const Problem& problem, const Operator& light, Iterate& iterate) = 0;
  /// How many iterations are usual.
  [[nodiscard]] virtual int usual_iterations() const = 0;

 protected:
  MethodOptions options_;
};

/// Names in the order of the manual.
[[nodiscard]] const std::vector<std::string>& method_names();
/// Throws Fault::usage for an unknown name or contradictory thresholds.
[[nodiscard]] std::unique_ptr<Method> make_method(const std::string& name, const MethodOptions& options);

/// g = filter(A f): may be negative, and A* g is about f.
void filtered_projections(const Operator& light, std::span<const Slab> object, std::vector<Slab>& g);

}  // namespace vam::optimize
