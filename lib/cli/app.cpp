// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/app.hpp"

#include <CLI/App.hpp>
#include <algorithm>

#include "base/error.hpp"
#include "base/index.hpp"
#include "base/text/text.hpp"
#include "cli/private/app_state.hpp"
#include "cli/private/values.hpp"

namespace vam::cli {

namespace {

std::string exact(double value) { return format_number(value, 17); }

}  // namespace

App::App(Manual manual) : state_(std::make_unique<State>()) {
  state_->owned = std::make_unique<CLI::App>();
  state_->parser = state_->owned.get();
  state_->parser->set_help_flag();
  state_->parser->require_subcommand(0, 1);  // an operand of the first may have the name of another
  state_->parser->option_defaults()->always_capture_default(false);
  state_->tool.manual = std::move(manual);
}

App::~App() = default;

App& App::group(const std::string& title, const std::vector<std::string>& only_with,
                const std::vector<std::string>& not_for) {
  state_->heading = title;
  state_->only_with = only_with;
  state_->not_for = not_for;
  return *this;
}

// Every option takes its text through one function that converts, checks and stores it.
App& App::declare(Option option, const std::function<void(const std::string&)>& store,
                  const std::function<std::string()>& value) {
  option.value = value;
  const std::string flag = long_flag(option);
  auto* parsed = state_->parser->add_option_function<std::vector<std::string>>(
      option.flag, [store](const std::vector<std::string>& texts) {
        for (const auto& text : texts) store(text);
      });
  parsed->expected(option.repeatable ? -1 : 1)->type_size(1)->allow_extra_args(false);
  parsed->multi_option_policy(option.repeatable ? CLI::MultiOptionPolicy::TakeAll : CLI::MultiOptionPolicy::Throw);
  state_->add(std::move(option));
  state_->operand_last = false;
  return *this;
}

// An operand is required when nothing stands for it, or when a required one follows.
App& App::positional(const std::string& value_name, std::string& target, const std::string& help) {
  state_->parser->add_option(value_name, target)->type_size(1)->expected(1);
  state_->tool.positionals.push_back({value_name, help, target, [&target] { return std::vector{target}; }});
  state_->operand_last = true;
  if (!target.empty()) return *this;
  for (auto& positional : state_->tool.positionals) positional.default_text.clear();
  return *this;
}

App& App::positional(const std::string& value_name, std::vector<std::string>& target, const std::string& help) {
  state_->tool.positionals.push_back({value_name, help, join(target, " "), [&target] { return target; }});
  state_->operand_last = true;
  state_->parser->add_option(split(value_name, ' ').front(), target)->type_size(1)->expected(-1);
  return *this;
}

App& App::option(const std::string& flag, const std::string& value_name, std::string& target, const std::string& help) {
  return declare(
      {flag, value_name, help, target, "", {}},
      [&target, flag, free_text = value_name == "TEXT"](const std::string& text) {
        // As of a shell variable that is not set; free text may be empty.
        if (text.empty() && !free_text)
          throw Error{Fault::usage, split(flag, ',').back() + ": is empty; give a value, or omit it"};
        target = text;
      },
      [&target] { return target; });
}

App& App::option(const std::string& flag, const std::string& value_name, double& target, Range range,
                 const std::string& help) {
  return declare(
      {flag, value_name, help, format_number(target), describe(range), {}},
      [&target, flag, range](const std::string& text) { target = checked_number(flag, text, range); },
      [&target] { return exact(target); });
}

App& App::option(const std::string& flag, const std::string& value_name, int& target, Range range,
                 const std::string& help) {
  return declare(
      {flag, value_name, help, std::to_string(target), describe(range), {}},
      [&target, flag, range](const std::string& text) { target = checked_integer(flag, text, range); },
      [&target] { return std::to_string(target); });
}

App& App::option(const std::string& flag, const std::string& value_name, std::optional<double>& target, Range range,
                 const std::string& help) {
  return declare(
      {flag, value_name, help, target ? format_number(*target) : "", describe(range), {}},
      [&target, flag, range](const std::string& text) { target = checked_number(flag, text, range); },
      [&target] { return target ? exact(*target) : ""; });
}

App& App::option(const std::string& flag, const std::string& value_name, std::optional<int>& target, Range range,
                 const std::string& help) {
  return declare(
      {flag, value_name, help, target ? std::to_string(*target) : "", describe(range), {}},
      [&target, flag, range](const std::string& text) { target = checked_integer(flag, text, range); },
      [&target] { return target ? std::to_string(*target) : ""; });
}

App& App::option(const std::string& flag, const std::string& value_name, std::vector<double>& target, int count,
                 const std::string& help) {
  std::vector<std::string> defaults;
  for (const double value : target) defaults.push_back(format_number(value));
  return declare(
      {flag, value_name, help, join(defaults, ","), "", {}},
      [&target, flag, count](const std::string& text) {
        const auto parts = split(text, ',');
        if (count > 0 && count_of(parts) != count) {
          throw Error{Fault::usage, flag + ": '" + text + "' has " + std::to_string(parts.size()) + " numbers; give " +
                                        std::to_string(count) + ", separated by commas"};
        }
        target.clear();
        for (const auto& part : parts) target.push_back(checked_number(flag, part, any));
      },
      [&target] {
        std::vector<std::string> values;
        for (const double value : target) values.push_back(exact(value));
        return join(values, ",");
      });
}

App& App::option(const std::string& flag, const std::string& value_name, std::vector<std::string>& target,
                 const std::string& help) {
  return declare(
      {flag, value_name, help, "", "", {}, true}, [&target](const std::string& text) { target.push_back(text); },
      [&target] { return join(target, ","); });
}

App& App::option(const std::string& flag, const std::string& value_name, Range range,
                 const std::function<void(int)>& store, const std::string& help, const std::string& default_text) {
  const auto given = std::make_shared<std::string>(default_text);
  return declare(
      {flag, value_name, help, default_text, describe(range), {}},
      [store, flag, range, given](const std::string& text) {
        store(checked_integer(flag, text, range));
        *given = text;
      },
      [given] { return *given; });
}

App& App::choice(const std::string& flag, std::string& target, const std::vector<std::string>& values,
                 const std::string& help) {
  return declare(
      {flag, "WORD", help, target, "", values},
      [&target, flag, values](const std::string& text) {
        if (std::find(values.begin(), values.end(), text) == values.end()) throw not_one_of(flag, text, values);
        target = text;
      },
      [&target] { return target; });
}

App& App::flag(const std::string& name, bool& target, const std::string& help) {
  state_->parser->add_flag(name, target);
  state_->add({name, "", help, "", "", {}});
  state_->operand_last = false;
  state_->current_group().options.back().value = [&target] { return std::string(target ? "1" : "0"); };
  return *this;
}

App& App::default_is(const std::string& text) {
  state_->current_group().options.back().default_text = text;
  return *this;
}

App& App::when_left_out(const std::string& number) {
  state_->current_group().options.back().implicit = number;
  return *this;
}

App& App::usual(const std::vector<std::string>& flags) {
  for (Group& group : state_->tool.groups) {
    for (Option& option : group.options) {
      option.usual = option.required || std::find(flags.begin(), flags.end(), long_flag(option)) != flags.end();
    }
  }
  return *this;
}

App& App::brief(const std::string& text) {
  state_->current_group().options.back().brief = text;
  return *this;
}

App& App::required() {
  Option& option = state_->current_group().options.back();
  option.required = true;
  option.default_text.clear();
  return *this;
}

App& App::required_without(const std::string& flag) {
  state_->current_group().options.back().unless = flag;
  return required();
}

App& App::not_in_job() {
  state_->current_group().options.back().in_job = false;
  return *this;
}

App& App::reads(const std::vector<std::string>& unless) {
  if (state_->operand_last) {
    state_->tool.positionals.back().reads = true;
    state_->tool.positionals.back().unless = unless;
  } else {
    state_->current_group().options.back().reads = true;
  }
  return *this;
}

App& App::writes(const std::vector<std::string>& endings) {
  state_->current_group().options.back().writes = true;
  state_->current_group().options.back().endings = endings;
  return *this;
}

App& App::writes_as(const std::vector<std::string>& endings) {
  writes(endings).state_->current_group().options.back().any_name = true;
  return *this;
}

App& App::form() {
  state_->current_group().options.back().form = true;
  return *this;
}

App& App::subcommand(const std::string& name, const std::string& summary, const std::function<void()>& body) {
  auto nested = std::unique_ptr<App>(new App(Manual{name, summary}));
  nested->state_->owned.reset();
  nested->state_->parser = state_->parser->add_subcommand(name, summary);
  nested->state_->parser->set_help_flag();
  nested->state_->body = body;
  state_->subcommands.push_back(std::move(nested));
  return *state_->subcommands.back();
}

}  // namespace vam::cli
