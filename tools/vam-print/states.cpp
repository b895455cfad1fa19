// SPDX-License-Identifier: GPL-3.0-or-later
#include "vam-print/states.hpp"

#include <string>

#include "base/error.hpp"
#include "base/text/text.hpp"

namespace vam::print_tool {

namespace {

// The table is in the order of the states; there is no way back, none from the dark to light, and from every motion one
// to standstill.
constexpr bool is_sound() {
  for (std::size_t i = 0; i < state_rules.size(); ++i) {
    const StateRule& rule = state_rules[i];
    if (rule.state != static_cast<State>(i) || (rule.next & (2 * bit(rule.state) - 1)) != 0) return false;
    if (rule.light && !rule.motion) return false;
    if (rule.motion && rule.state < State::dark && (rule.next & bit(State::dark)) == 0) return false;
    if (rule.state >= State::dark && (rule.light || rule.tool_lost != Loss::ignored)) return false;
  }
  return true;
}
static_assert(is_sound());

std::string paragraph_of(const StateRule& rule) {
  std::string text = std::string(rule.name) + ": " + std::string(rule.meaning);
  std::vector<std::string> next;
  for (const StateRule& other : state_rules) {
    if ((rule.next & bit(other.state)) != 0) next.emplace_back(other.name);
  }
  return text + (next.empty() ? "" : "; then " + join(next, " or ")) + ".";
}

}  // namespace

std::vector<std::string> state_texts() {
  std::vector<std::string> texts;
  for (const StateRule& rule : state_rules) texts.push_back(paragraph_of(rule));
  return texts;
}

void Life::enter(State next) {
  if ((rule().next & bit(next)) == 0) {
    throw Error{Fault::bug,
                "a print that is " + std::string(rule().name) + " cannot become " + std::string(rule_of(next).name)};
  }
  state_ = next;
}

void Life::reach(State next) {
  while (state_ < next) {
    if ((rule().next & bit(next)) != 0) return enter(next);
    State step = state_;
    do step = static_cast<State>(static_cast<int>(step) + 1);
    while ((rule().next & bit(step)) == 0);
    enter(step);
  }
}

}  // namespace vam::print_tool
