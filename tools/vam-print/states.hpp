// SPDX-License-Identifier: GPL-3.0-or-later
// The life of a print: in which states it can be, and what is allowed in each.
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

namespace vam::print_tool {

enum class State { armed, homed, turning, lit, held, dark, still, done };

/// What the end of a tool means to a print in a state.
enum class Loss {
  fails,    // it ends the print: dark, then still
  is_held,  // the print goes on without it, in open loop
  ignored,  // as it is over
};

struct StateRule {
  State state;
  std::string_view name;
  std::string_view meaning;
  bool light;       // an image may be lit
  bool motion;      // the stage may turn
  Loss views_lost;  // the camera or vam-ost fails, of a print that is corrected
  Loss tool_lost;   // any other tool fails, or these of any other print
  unsigned next;    // states that may follow, a bit each
};

constexpr unsigned bit(State state) { return 1U << static_cast<unsigned>(state); }

/// The one table. A state is left only for one that it names.
inline constexpr std::array<StateRule, 8> state_rules{{
    {State::armed, "armed", "records, settings and devices are in order; no tool runs", false, false, Loss::fails,
     Loss::fails, bit(State::homed) | bit(State::done)},
    {State::homed, "homed", "the tools run; frames are loaded, the stage finds its reference", false, true, Loss::fails,
     Loss::fails, bit(State::turning) | bit(State::dark)},
    {State::turning, "turning", "the stage turns, in the dark", false, true, Loss::fails, Loss::fails,
     bit(State::lit) | bit(State::dark)},
    {State::lit, "lit", "images are shown", true, true, Loss::is_held, Loss::fails,
     bit(State::held) | bit(State::dark)},
    {State::held, "held", "images are shown as they were last, without camera or vam-ost", true, true, Loss::ignored,
     Loss::fails, bit(State::dark)},
    {State::dark, "dark", "the light is off, or ordered to be; the stage stops", false, true, Loss::ignored,
     Loss::ignored, bit(State::still)},
    {State::still, "still", "every tool has ended", false, false, Loss::ignored, Loss::ignored, bit(State::done)},
    {State::done, "done", "the records are complete", false, false, Loss::ignored, Loss::ignored, 0},
}};

constexpr const StateRule& rule_of(State state) { return state_rules[static_cast<std::size_t>(state)]; }

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

/// The table for the manual: a paragraph for each state.
[[nodiscard]] inline std::vector<std::string> state_texts() {
  std::vector<std::string> texts;
  for (const StateRule& rule : state_rules) {
    std::string next;
    for (const StateRule& other : state_rules) {
      if ((rule.next & bit(other.state)) != 0) next += (next.empty() ? "; then " : " or ") + std::string(other.name);
    }
    texts.push_back(std::string(rule.name) + ": " + std::string(rule.meaning) + next + ".");
  }
  return texts;
}

/// The state of a print.
class Life {
 public:
  [[nodiscard]] State state() const { return state_; }
  [[nodiscard]] const StateRule& rule() const { return rule_of(state_); }
  /// Through those between, to what is at least as late; nothing where it is later already.
  void reach(State next) {
    while (state_ < next) {
      State step = next;  // the earliest one that may follow, unless `next` itself may
      for (auto n = state_rules.size(); (rule().next & bit(next)) == 0 && n-- > 0;) {
        if ((rule().next & bit(static_cast<State>(n))) != 0) step = static_cast<State>(n);
      }
      state_ = step;
    }
  }

 private:
  State state_ = State::armed;
};

}  // namespace vam::print_tool
