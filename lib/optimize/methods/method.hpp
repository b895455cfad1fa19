// SPDX-License-Identifier: GPL-3.0-or-later
// What every optimiser has in common. A method is one file, which implements Method and fills in its MethodEntry, and
// two lines in methods.cpp.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "light/operators/operator.hpp"
#include "optimize/methods/archive.hpp"
#include "optimize/methods/scenarios.hpp"
#include "optimize/target/problem.hpp"

namespace vam::optimize {

/// Projections and the dose they give. Methods keep the two in step, so that looking at an iterate costs nothing.
struct Iterate {
  std::vector<Slab> g;     // sinograms
  std::vector<Slab> dose;  // A* g
};

/// How far the print's surface lies from the target's, outwards positive, in voxels; every point no more than one.
struct SurfaceMiss {
  double mean = 0;
  double rms = 0;
};

/// Defaults are the ones the manual shows. A method reads those it needs.
struct MethodOptions {
  double void_dose = 0.5;    // B of the void, 0...1
  double min_intensity = 0;  // lower bound on projected intensity
  bool offset = false;       // raise all projections by the lowest value instead of clipping
  double max_intensity = 0;  // upper bound on projected intensity; 0: none
  double power = 2;          // p of the norm, at least 1
};

class Method {
 public:
  explicit Method(const MethodOptions& options) : options_(options) {}
  virtual ~Method() = default;
  Method(const Method&) = delete;
  Method& operator=(const Method&) = delete;

  /// First iterate, from nothing. The default is clipped filtered back-projection.
  virtual void start(const Problem& problem, const light::Operator& light, Iterate& iterate);
  /// First iterate, from given projections iterate.g. The default clips them to the upper bound on intensity and
  /// computes their dose.
  virtual void resume(const Problem& problem, const light::Operator& light, Iterate& iterate);
  /// One iteration.
  virtual void step(const Problem& problem, const light::Operator& light, Iterate& iterate) = 0;
  /// Goes on with a higher upper bound on intensity.
  void allow(double max_intensity) { options_.max_intensity = max_intensity; }
  /// Printers in whose light the loss counts, too; they must outlive the method's last step. Only of methods that read
  /// --robust.
  void set_scenarios(const Scenarios& scenarios) { scenarios_ = &scenarios; }
  /// Writes or reads what the next step needs beside the iterate, so that a run can be interrupted and resume.
  virtual void exchange(Archive& archive) = 0;
  /// Doses have their true scale, as slices that share dose need; else each slice is scaled to a largest dose of 1.
  [[nodiscard]] virtual bool keeps_scale() const { return false; }
  /// Errors of the dose at the surface, of a method that optimises them; else nothing.
  [[nodiscard]] virtual std::optional<SurfaceMiss> surface_miss(std::span<const Slab> /*dose*/) const {
    return std::nullopt;
  }
  /// Whether it asks for more than the nominal doses show: for other printers.
  [[nodiscard]] virtual bool asks_more() const { return false; }
  /// max_V x / min_G x of no light within the limit is less, with the threshold in the middle; 0: not known.
  [[nodiscard]] virtual double provable_ratio() const { return 0; }

 protected:
  MethodOptions options_;
  const Scenarios* scenarios_ = nullptr;
};

/// Description of a method, for --help, manual, errors and tests of vam-optimize.
struct MethodEntry {
  std::string name;
  std::string summary;               // sentences
  int iterations;                    // default of --iterations
  bool grey;                         // supports grey targets
  std::vector<std::string> options;  // of vam-optimize, and settings, that not every method reads
  std::unique_ptr<Method> (*make)(const MethodOptions&);
  std::unique_ptr<Method> (*make_robust)(const MethodOptions&) = nullptr;  // that faces scenarios, where it can
  double softness = usual_softness;                                        // default width of the logistic response
  int more_slices = 0, more_sinograms = 0;  // arrays of them that it keeps beside those of every method
};

[[nodiscard]] bool reads(const MethodEntry& method, const std::string& option);

/// For MethodEntry::make.
template <class Chosen>
std::unique_ptr<Method> make(const MethodOptions& options) {
  return std::make_unique<Chosen>(options);
}

/// In the order of the manual.
[[nodiscard]] const std::vector<MethodEntry>& method_table();
/// Throws Fault::usage for an unknown name.
[[nodiscard]] const MethodEntry& method_entry(const std::string& name);
[[nodiscard]] std::unique_ptr<Method> make_method(const std::string& name, const MethodOptions& options);

[[nodiscard]] std::vector<std::string> method_names();
/// Those for which `holds` is true.
[[nodiscard]] std::vector<std::string> method_names(const std::function<bool(const MethodEntry&)>& holds);

/// iterate.dose = A* iterate.g, and what was delivered already.
void find_dose(const Problem& problem, const light::Operator& light, Iterate& iterate);

/// Scales each slice to the common threshold.
void start_at_threshold(const Problem& problem, const light::Operator& light, Iterate& iterate);

/// g = filter(A f): may be negative, and A* g is about f.
void filtered_projections(const light::Operator& light, std::span<const Slab> object, std::vector<Slab>& g);

}  // namespace vam::optimize
