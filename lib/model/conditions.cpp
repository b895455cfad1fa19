// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/conditions.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "base/error.hpp"
#include "base/text/text.hpp"

namespace vam::model {

namespace {

double number(const std::string& text, const std::string& clause) {
  double value = 0;
  const char* end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc{} || rest != end || !std::isfinite(value)) {
    throw Error{Fault::usage, "'" + clause + "': '" + text + "' is not a number; write for example ver<=0.01"};
  }
  return value;
}

Condition parse_clause(const std::string& clause, const std::vector<std::string>& known,
                       const std::vector<std::string>& in_percent) {
  const auto at = clause.find_first_of("<>=");
  if (at == std::string::npos) {
    throw Error{Fault::usage, "'" + clause + "' has no relation (<=, >=, <, >, =); write for example ver<=0.01"};
  }
  const bool two = clause[at] != '=' && at + 1 < clause.size() && clause[at + 1] == '=';
  Condition condition;
  condition.name = trimmed(clause.substr(0, at));
  condition.relation = clause.substr(at, two ? 2 : 1);
  if (std::find(known.begin(), known.end(), condition.name) == known.end()) {
    throw Error{Fault::usage,
                "'" + clause + "': unknown figure '" + condition.name + "'; expected one of " + join(known, ", ")};
  }
  std::string bound = trimmed(clause.substr(at + condition.relation.size()));
  const bool percent = std::find(in_percent.begin(), in_percent.end(), condition.name) != in_percent.end();
  if (percent && bound.ends_with('%')) bound = trimmed(bound.substr(0, bound.size() - 1));
  condition.bound = number(bound, clause);
  return condition;
}

}  // namespace

std::vector<Condition> parse_conditions(const std::string& text, const std::vector<std::string>& known,
                                        const std::vector<std::string>& in_percent) {
  std::vector<Condition> conditions;
  for (std::size_t from = 0; from <= text.size();) {
    const auto comma = std::min(text.find(',', from), text.size());
    const std::string clause = trimmed(text.substr(from, comma - from));
    if (clause.empty()) {
      throw Error{Fault::usage, "'" + text + "' has an empty condition; write for example 'ver<=0.01,pw>=0'"};
    }
    conditions.push_back(parse_clause(clause, known, in_percent));
    from = comma + 1;
  }
  return conditions;
}

bool holds(const Condition& condition, double value) {
  if (condition.relation == "<=") return value <= condition.bound;
  if (condition.relation == ">=") return value >= condition.bound;
  if (condition.relation == "<") return value < condition.bound;
  if (condition.relation == ">") return value > condition.bound;
  return value == condition.bound;
}

std::vector<std::string> unmet(const std::vector<Condition>& conditions, const FigureOf& value) {
  std::vector<std::string> lines;
  for (const auto& c : conditions) {
    const double is = value(c.name);
    if (!holds(c, is)) {
      lines.push_back(c.name + (std::isnan(is) ? " is not known" : " = " + format_number(is)) + ", but " + c.name +
                      c.relation + format_number(c.bound) + " is required");
    }
  }
  return lines;
}

void require_met(const std::vector<Condition>& conditions, const FigureOf& value) {
  const auto failures = unmet(conditions, value);
  if (!failures.empty()) throw Error{Fault::judged, join(failures, "; ")};
}

}  // namespace vam::model
