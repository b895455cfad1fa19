// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <iterator>
#include <string>
#include <string_view>

#include "base/text/text.hpp"
#include "cli/private/declaration.hpp"

namespace vam::cli {

namespace {
constexpr int width = 80;
constexpr int indent = 6;

// "--flips FILE" for each option that must be given, "SLICES" for each operand, in brackets where it may be left out.
std::string operands(const Declaration& form) {
  std::string text;
  for (const auto& option : required_options(form)) {
    text += " " + long_flag(option) + (option.value_name.empty() ? "" : " " + value_words(option));
  }
  for (const auto& positional : form.positionals) {
    const bool optional = !positional.default_text.empty();
    text += optional ? " [" + positional.value_name + "]" : " " + positional.value_name;
  }
  return text;
}

std::string usage(const Declaration& tool) {
  const std::string name = tool.manual.name;
  std::vector<std::string> lines;
  const auto add = [&](const Declaration& declared, const std::string& words) {
    for (const auto& form : forms_of(declared)) {
      lines.push_back(words + (form.groups.empty() ? "" : " [OPTIONS]") + operands(form));
    }
  };
  if (has_plain_form(tool)) add(tool, name);
  for (const auto& nested : tool.subcommands) add(nested, name + " " + nested.manual.name);
  return "Usage: " + join(lines, "\n       ") + "\n";
}

/// The first sentence, to its full stop.
std::string first_sentence(const std::string& text) {
  for (std::size_t at = text.find(". "); at != std::string::npos; at = text.find(". ", at + 1)) {
    if (!std::string_view(text).substr(0, at).ends_with("e.g")) return text.substr(0, at + 1);
  }
  return text;
}

/// In short: what an option is for, its words and its default, or what its tool says instead.
std::string brief_text(Option option) {
  if (!option.brief.empty()) return option.brief;
  option.help = first_sentence(option.help);
  option.range_text.clear();
  option.rules.clear();
  option.not_for.clear();
  return join(details(option), " ");
}

std::string words_of(const Option& option) {
  return join(split(option.flag, ','), ", ") + (option.value_name.empty() ? "" : " " + value_words(option));
}

std::string help_text(const Group& group) {
  std::string text = group.title + ":\n";
  for (const auto& option : group.options)
    text += "  " + words_of(option) + "\n" + wrap(join(details(option), " "), width, indent);
  return text;
}

/// Side by side, where the words leave room for it.
std::string brief_entry(const std::string& words, const std::string& text) {
  constexpr std::size_t column = 24;
  const std::string wrapped = wrap(text, width, column);
  const std::size_t used = 2 + words.size();
  return "  " + words + (used + 2 > column ? "\n" + wrapped : wrapped.substr(used));
}

std::string names_of_all() {
  std::vector<std::string> names;
  for (const Option& option : common_options()) names.push_back(words_of(option));
  return join(names, "; ");
}

/// The usual options as one list, and how many are left out.
std::string usual_text(const Declaration& tool) {
  std::string text = "Options:\n";
  std::size_t hidden = 0;
  for (const Group& group : tool.groups) {
    for (const Option& option : group.options) {
      if (option.usual) text += brief_entry(words_of(option), brief_text(option));
      if (!option.usual) ++hidden;
    }
  }
  return text + "\n" + std::to_string(hidden) + " more options, and all of each: " + tool.manual.name +
         " --help=all\n" + "Common options: " + names_of_all() + ";\n";
}

}  // namespace

bool has_usual(const Declaration& tool) {
  return std::any_of(tool.groups.begin(), tool.groups.end(), [](const Group& group) {
    return std::any_of(group.options.begin(), group.options.end(), [](const Option& option) { return option.usual; });
  });
}

bool has_plain_form(const Declaration& tool) {
  return tool.subcommands.empty() || !tool.positionals.empty() || !tool.groups.empty();
}

std::vector<Option> required_options(const Declaration& form) {
  std::vector<Option> found;
  for (const auto& group : form.groups) {
    std::copy_if(group.options.begin(), group.options.end(), std::back_inserter(found),
                 [](const Option& option) { return option.required; });
  }
  return found;
}

std::vector<Declaration> forms_of(const Declaration& tool) {
  std::vector<Declaration> forms{tool};
  for (std::size_t g = 0; g < tool.groups.size(); ++g) {
    for (std::size_t i = 0; i < tool.groups[g].options.size(); ++i) {
      if (!tool.groups[g].options[i].form) continue;
      Declaration form = tool;
      form.groups[g].options[i].required = true;
      const std::string flag = long_flag(form.groups[g].options[i]);
      for (auto& group : form.groups) {
        for (auto& option : group.options) option.required = option.required && option.unless != flag;
      }
      std::erase_if(form.positionals, [&](const Positional& positional) {
        return std::find(positional.unless.begin(), positional.unless.end(), flag) != positional.unless.end();
      });
      forms.push_back(form);
    }
  }
  return forms;
}

std::vector<std::string> details(const Option& option) {
  std::vector<std::string> texts{option.help};
  if (!option.choices.empty()) texts.push_back("One of " + join(option.choices, ", ") + ".");
  if (!option.range_text.empty()) texts.push_back("Range: " + option.range_text + ".");
  if (!option.default_text.empty()) texts.push_back("Default: " + option.default_text + ".");
  if (!option.implicit.empty()) texts.push_back("Without a number: " + option.implicit + ".");
  if (option.repeatable) texts.emplace_back("May be repeated.");
  if (option.required) texts.push_back(option.unless.empty() ? "Required." : "Required without " + option.unless + ".");
  for (const auto& text : rule_texts(option)) texts.push_back(text);
  return texts;
}

std::string details(const Positional& positional) {
  if (positional.default_text.empty()) return positional.help;
  return positional.help +
         " Default: " + (positional.default_text == "-" ? std::string("standard input") : positional.default_text) +
         ".";
}

std::string long_flag(const Option& option) {
  const auto names = split(option.flag, ',');
  for (const auto& name : names) {
    if (name.rfind("--", 0) == 0) return name;
  }
  return option.flag;
}

std::string value_words(const Option& option) {
  return option.implicit.empty() ? option.value_name : "[" + option.value_name + "]";
}

std::vector<ExitStatus> exit_statuses(const Declaration& tool) {
  std::vector<ExitStatus> statuses{
      {0, "Success."},
      {64, "Wrong options or operands; nothing was opened."},
      {65, "Bad input data."},
      {66, "An input cannot be opened."},
      {70, "Internal error."},
      {71, "Out of memory."},
      {73, "An output cannot be created."},
      {74, "A read or write failed, the final flush included."},
  };
  if (find_option(tool, "--require") != nullptr) statuses.push_back({1, "A condition of --require does not hold."});
  statuses.insert(statuses.end(), tool.manual.statuses.begin(), tool.manual.statuses.end());
  std::sort(statuses.begin(), statuses.end(), [](const auto& a, const auto& b) { return a.code < b.code; });
  return statuses;
}

std::string help_text(const Declaration& tool, bool all) {
  std::string text = usage(tool) + wrap(tool.manual.summary, width, 2) + "\n";
  if (!tool.subcommands.empty()) text += "Commands:\n";
  for (const auto& nested : tool.subcommands) text += brief_entry(nested.manual.name, nested.manual.summary);
  if (!tool.subcommands.empty()) text += "\n";
  const bool whole = all || !has_usual(tool);
  for (const auto& positional : tool.positionals) {
    text += whole ? "  " + positional.value_name + "\n" + wrap(details(positional), width, indent)
                  : brief_entry(positional.value_name, details(positional));
  }
  if (!tool.positionals.empty()) text += "\n";
  if (!all && !has_plain_form(tool)) {  // each command has options of its own
    text += "Options of a command, e.g.: " + tool.manual.name + " " + tool.subcommands.front().manual.name +
            " --help\n" + "Common options: " + names_of_all() + ";\n";
  } else if (whole) {
    for (const Group& group : tool.groups) text += help_text(group) + "\n";
    text += help_text(Group{"Common options", common_options()});
  } else {
    text += usual_text(tool);
  }
  text += "  -h, --help; --version; --man (the manual page); --completion bash|zsh|fish\n";
  return text;
}

}  // namespace vam::cli
