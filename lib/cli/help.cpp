#include <string>

#include "base/text.hpp"
#include "cli/declaration.hpp"

namespace vam::cli {

namespace {
constexpr int width = 80;
constexpr int indent = 6;

std::string usage(const Declaration& tool) {
  std::string line = "Usage: " + tool.manual.name;
  if (!tool.subcommands.empty()) line += " COMMAND";
  line += " [OPTIONS]";
  for (const auto& positional : tool.positionals)
    line += " [" + positional.value_name + (positional.many ? "...]" : "]");
  return line + "\n";
}

std::string details(const Option& option) {
  std::string text = option.help;
  if (!option.choices.empty()) text += " One of " + join(option.choices, ", ") + ".";
  if (!option.range_text.empty()) text += " Range: " + option.range_text + ".";
  if (!option.default_text.empty()) text += " Default: " + option.default_text + ".";
  if (option.repeatable) text += " May be repeated.";
  return text;
}

}  // namespace

std::string long_flag(const Option& option) {
  const auto names = split(option.flag, ',');
  for (const auto& name : names) {
    if (name.rfind("--", 0) == 0) return name;
  }
  return option.flag;
}

const std::vector<ExitStatus>& exit_statuses() {
  static const std::vector<ExitStatus> statuses{
      {0, "Done."},
      {1, "A judged comparison failed (--require)."},
      {64, "Wrong options or arguments; nothing was opened."},
      {65, "Bad input data."},
      {66, "An input cannot be opened."},
      {69, "A device is absent."},
      {70, "Internal error."},
      {71, "Out of memory."},
      {73, "An output cannot be created."},
      {74, "A read or write failed, the final flush included."},
      {75, "A device is busy or timed out; try again."},
      {76, "A device spoke nonsense."},
  };
  return statuses;
}

std::string help_text(const Declaration& tool) {
  std::string text = usage(tool) + wrap(tool.manual.summary, width, 2) + "\n";
  if (!tool.subcommands.empty()) text += "Commands:\n";
  for (const auto& nested : tool.subcommands) {
    text += "  " + nested.manual.name + "\n" + wrap(nested.manual.summary, width, indent);
  }
  if (!tool.subcommands.empty()) text += "\n";
  for (const auto& positional : tool.positionals) {
    text += "  " + positional.value_name + "\n" + wrap(positional.help, width, indent);
  }
  if (!tool.positionals.empty()) text += "\n";
  for (const auto& group : tool.groups) {
    text += group.title + ":\n";
    for (const auto& option : group.options) {
      text += "  " + join(split(option.flag, ','), ", ");
      if (!option.value_name.empty()) text += " " + option.value_name;
      text += "\n" + wrap(details(option), width, indent);
    }
    text += "\n";
  }
  text += "Help:\n  -h, --help; --version; --man (the manual page); --completion bash|zsh|fish\n";
  return text;
}

}  // namespace vam::cli
