// What every optimiser has in common. A method is one file that implements Method and one line in methods.cpp.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "light/operator.hpp"
#include "optimize/methods/archive.hpp"
#include "optimize/target/problem.hpp"

namespace vam::optimize {

/// Projections and the dose they give. Methods keep the two in step, so that looking at an iterate costs nothing.
struct Iterate {
  std::vector<Slab> g;     // sinograms
  std::vector<Slab> dose;  // A* g
};

/// Defaults are the ones the manual shows. A method reads those it needs.
struct MethodOptions {
  double background = 0.5;  // dose-norm: B, 0...1
  double floor = 0;         // fbp, dose-norm: projections are not let below it (fluence)
  bool offset = false;      // fbp: raise all projections by the lowest value instead of clipping
  double peak = 0;          // largest fluence, 0 = any: cal, osmo, apg, pm, bclp
  double power = 2;         // pm, bclp: p of the norm, at least 1
};

class Method {
 public:
  explicit Method(const MethodOptions& options) : options_(options) {}
  virtual ~Method() = default;
  Method(const Method&) = delete;
  Method& operator=(const Method&) = delete;

  /// First iterate, from nothing. The default is clipped filtered back-projection.
  virtual void start(const Problem& problem, const light::Operator& light, Iterate& iterate);
  /// First iterate, from given projections iterate.g. The default computes their dose.
  virtual void resume(const Problem& problem, const light::Operator& light, Iterate& iterate);
  /// One iteration.
  virtual void step(const Problem& problem, const light::Operator& light, Iterate& iterate) = 0;
  /// Writes or reads what the next step needs beside the iterate, so that a run can be broken off and go on.
  virtual void exchange(Archive& archive) = 0;
  /// Doses have their true scale, as slices that share dose need; else each slice is scaled to a largest dose of 1.
  [[nodiscard]] virtual bool keeps_scale() const { return false; }
  /// Responses of a grey target can be met.
  [[nodiscard]] virtual bool takes_grey() const { return false; }
  /// How many iterations are usual.
  [[nodiscard]] virtual int usual_iterations() const = 0;

 protected:
  MethodOptions options_;
};

/// Names in the order of the manual.
[[nodiscard]] const std::vector<std::string>& method_names();
/// Throws Fault::usage for an unknown name.
[[nodiscard]] std::unique_ptr<Method> make_method(const std::string& name, const MethodOptions& options);

/// Scales each slice to the common threshold.
void start_at_threshold(const Problem& problem, const light::Operator& light, Iterate& iterate);

/// g = filter(A f): may be negative, and A* g is about f.
void filtered_projections(const light::Operator& light, std::span<const Slab> object, std::vector<Slab>& g);

}  // namespace vam::optimize
