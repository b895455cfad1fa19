// SPDX-License-Identifier: GPL-3.0-or-later
// Forward models of printers that deviate from their settings, applied to the frames of the nominal printer.
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "base/index.hpp"
#include "light/operators/make_operator.hpp"
#include "model/printer.hpp"
#include "model/tolerances.hpp"

namespace vam::optimize {

/// One such printer. Its operator has the nominal's objects and images; the columns of its sinograms may differ.
struct Scenario {
  std::unique_ptr<light::Operator> light;
  double blur_px = 0;    // standard deviation of what beam and resin smear
  double intensity = 1;  // of the lamp, as a multiple of its setting
  double rim = 0;        // intensity that the image's corners lack, of its middle's
};

/// A printer whose settings are known to tolerances, in light on the voxels of a part that was sliced for it as set.
struct TolerantPrinter {
  model::Printer printer;
  model::Tolerances tolerances{};
  std::function<light::VialSetup(const model::Printer& printer)> setup;
  std::function<double(const model::Resin& resin)> blur_px;
};
/// Throws as model::deviate().
[[nodiscard]] Scenario scenario_of(const TolerantPrinter& printer, const model::PrinterDeviation& by,
                                   std::span<const Slab> inserts);
/// Of model::balanced_corners().
[[nodiscard]] std::vector<Scenario> corner_scenarios(const TolerantPrinter& printer, std::span<const Slab> inserts);

/// The scenarios of a pass, in pairs off the settings in opposite ways.
class Scenarios {
 public:
  /// `nominal` must outlive this; `slices` are in use. An even number of scenarios, 2n and 2n + 1 a pair.
  Scenarios(const light::Operator& nominal, std::vector<Scenario> bank, int slices);
  Scenarios(const Scenarios&) = delete;
  Scenarios& operator=(const Scenarios&) = delete;

  [[nodiscard]] int count() const { return count_of(bank_); }
  /// Dose of the nominal's sinograms in the light of that scenario.
  void adjoint(int scenario, std::span<const Slab> sinograms, std::span<Slab> objects) const;
  /// Its transpose.
  void forward(int scenario, std::span<const Slab> objects, std::span<Slab> sinograms) const;
  /// The pair whose turn it is: every pair once in any count() / 2 iterations from a multiple of it, in an order drawn
  /// for each such round.
  [[nodiscard]] std::pair<int, int> drawn(int iteration) const;

 private:
  struct Member {
    Scenario scenario;
    std::unique_ptr<light::Operator> blurred;  // around the scenario's, or none
    [[nodiscard]] const light::Operator& light() const { return blurred ? *blurred : *scenario.light; }
  };
  const light::Operator& nominal_;
  std::vector<Member> bank_;
};

}  // namespace vam::optimize
