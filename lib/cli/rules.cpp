// SPDX-License-Identifier: GPL-3.0-or-later
// Which options need and exclude each other, and what kinds of input they are not for: declared, checked and printed.
#include <CLI/App.hpp>
#include <algorithm>

#include "base/error.hpp"
#include "base/text/text.hpp"
#include "cli/app.hpp"
#include "cli/private/app_state.hpp"

namespace vam::cli {

namespace {

/// "--method pm, bclp or --grey-target" of {"--method pm", "--method bclp", "--grey-target"}.
std::string listed(const std::vector<std::string>& conditions) {
  std::string text;
  std::string flag;
  for (std::size_t i = 0; i < conditions.size(); ++i) {
    const std::string& condition = conditions[i];
    const std::string its_flag = condition.substr(0, condition.find(' '));
    if (i > 0) text += i + 1 == conditions.size() ? " or " : ", ";
    text += its_flag == flag ? condition.substr(its_flag.size() + 1) : condition;
    flag = its_flag;
  }
  return text;
}

bool has_value(const Option& option, const std::string& value) {
  return value.starts_with('.') ? option.value().ends_with(value) : option.value() == value;
}

}  // namespace

App& App::only_with(const std::vector<std::string>& any_of, const std::string& value) {
  state_->current_group().options.back().rules.push_back({value, false, any_of});
  return *this;
}

App& App::excludes(const std::vector<std::string>& conditions, const std::string& value) {
  state_->current_group().options.back().rules.push_back({value, true, conditions});
  return *this;
}

App& App::not_for(const std::vector<std::string>& kinds) {
  auto& known = state_->current_group().options.back().not_for;
  known.insert(known.end(), kinds.begin(), kinds.end());
  return *this;
}

bool App::holds(const std::string& condition) const {
  const std::string flag = condition.substr(0, condition.find(' '));
  const Option* option = find_option(state_->tool, flag);
  if (option == nullptr) throw Error{Fault::bug, condition + ": a rule names an option that is not declared"};
  if (flag == condition) return given(flag);
  const std::string value = condition.substr(flag.size() + 1);
  const auto& choices = option->choices;
  if (!choices.empty() && std::find(choices.begin(), choices.end(), value) == choices.end())
    throw Error{Fault::bug, condition + ": a rule names a value that is not declared"};
  return has_value(*option, value);
}

// Of a form, the plain one or a command, before anything is known of the printer.
void App::require_rules() const {
  for (const auto& positional : state_->tool.positionals) {
    const std::string name = split(positional.value_name, ' ').front();
    for (const auto& flag : positional.unless) {
      if (given(name) && given(flag))
        throw Error{Fault::usage, name + ": conflicts with " + flag + "; omit one of them"};
    }
  }
  require_rules(nullptr);
}

void App::require_settings(const std::function<bool(const std::string&)>& is_set) const {
  form_in_use().require_rules(is_set);
}

// Those that name settings, or else the others.
void App::require_rules(const std::function<bool(const std::string&)>& is_set) const {
  const auto names_option = [](const std::string& condition) { return condition.starts_with("--"); };
  for (const auto& group : state_->tool.groups) {
    for (const auto& option : group.options) {
      for (const Rule& rule : option.rules) {
        const bool of_options = std::all_of(rule.conditions.begin(), rule.conditions.end(), names_option);
        if (of_options && !is_set) require_rule(option, rule, [this](const std::string& one) { return holds(one); });
        if (!of_options && is_set) require_rule(option, rule, is_set);
      }
    }
  }
}

// All conditions are evaluated, so that a misspelt one shows whatever is given.
void App::require_rule(const Option& option, const Rule& rule,
                       const std::function<bool(const std::string&)>& is_true) const {
  std::vector<std::string> held;
  for (const auto& condition : rule.conditions) {
    if (is_true(condition)) held.push_back(condition);
  }
  const bool in_use = given(long_flag(option)) && (rule.value.empty() || has_value(option, rule.value));
  if (!in_use || held.empty() == rule.excludes) return;
  const std::string subject = long_flag(option) + (rule.value.empty() ? "" : " " + rule.value);
  if (rule.excludes) throw Error{Fault::usage, subject + ": conflicts with " + held.front() + "; omit one of them"};
  throw Error{Fault::usage, subject + ": requires " + listed(rule.conditions) + "; give it, or omit " + subject};
}

void App::require_for(const std::string& kind, const std::string& name) const {
  for (const auto& group : form_in_use().state_->tool.groups) {
    for (const auto& option : group.options) {
      const auto& kinds = option.not_for;
      if (!given(long_flag(option)) || std::find(kinds.begin(), kinds.end(), kind) == kinds.end()) continue;
      throw Error{Fault::usage, long_flag(option) + ": does not apply to " + kind + " (" + name + "); omit it"};
    }
  }
}

std::vector<std::string> rule_texts(const Option& option) {
  std::vector<std::string> texts;
  for (const Rule& rule : option.rules) {
    const std::string verb = rule.value.empty() ? (rule.excludes ? "Not with " : "Requires ")
                                                : rule.value + (rule.excludes ? ": not with " : ": requires ");
    texts.push_back(verb + listed(rule.conditions) + ".");
  }
  if (!option.not_for.empty()) texts.push_back("Not for " + listed(option.not_for) + ".");
  return texts;
}

}  // namespace vam::cli
