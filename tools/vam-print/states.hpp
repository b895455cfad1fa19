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

/// The table for the manual: a paragraph for each state.
[[nodiscard]] std::vector<std::string> state_texts();

/// The state of a print. Throws Fault::bug for a step that the table does not have.
class Life {
 public:
  [[nodiscard]] State state() const { return state_; }
  [[nodiscard]] const StateRule& rule() const { return rule_of(state_); }
  void enter(State next);
  /// Through those between, to what is at least as late; nothing where it is later already.
  void reach(State next);

 private:
  State state_ = State::armed;
};

}  // namespace vam::print_tool
