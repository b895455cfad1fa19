// SPDX-License-Identifier: GPL-3.0-or-later
// Conditions on named figures, as in --require 'ver<=0.01,pw>=0'.
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace vam::model {

struct Condition {
  std::string name;
  std::string relation;  // <= >= < > =
  double bound = 0;
};

/// "name relation number" separated by commas; blanks are allowed. Names must be among `known`.
/// Figures that are in per cent already may say so: "missing<=0.5%".
/// Throws Fault::usage naming the clause that is wrong and the names that exist.
[[nodiscard]] std::vector<Condition> parse_conditions(const std::string& text, const std::vector<std::string>& known,
                                                      const std::vector<std::string>& in_percent = {});

[[nodiscard]] bool holds(const Condition& condition, double value);

using FigureOf = std::function<double(const std::string& name)>;  // not a number: not known

/// "ver = 0.02, but ver<=0.01 is required" for every condition that does not hold (or whose figure is not known).
[[nodiscard]] std::vector<std::string> unmet(const std::vector<Condition>& conditions, const FigureOf& value);

/// Throws Fault::judged with what is unmet.
void require_met(const std::vector<Condition>& conditions, const FigureOf& value);

}  // namespace vam::model
