// SPDX-License-Identifier: GPL-3.0-or-later
#include <string>

#include "base/error.hpp"
#include "base/text/text.hpp"
#include "cli/private/command_line.hpp"
#include "cli/private/declaration.hpp"

namespace vam::cli {

namespace {

std::vector<const Option*> own_options(const Declaration& tool) {
  std::vector<const Option*> options;
  for (const auto& group : tool.groups) {
    for (const auto& option : group.options) options.push_back(&option);
  }
  for (const auto& nested : tool.subcommands) {
    for (const Option* option : own_options(nested)) options.push_back(option);
  }
  return options;
}

std::vector<const Option*> completed_options(const Declaration& tool) {
  std::vector<const Option*> options = own_options(tool);
  for (const Option& option : common_options()) options.push_back(&option);
  return options;
}

// Single-quoted for any shell.
std::string literal(const std::string& text) {
  std::string out = "'";
  for (const char c : text) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return out + "'";
}

std::string bash(const Declaration& tool) {
  std::string function = "_" + tool.manual.name;
  std::string flags = join(about_flags(), " ");
  std::string cases;
  for (const Option* option : completed_options(tool)) {
    flags += " " + long_flag(*option);
    if (!option->choices.empty()) {
      cases += "    " + long_flag(*option) + ") COMPREPLY=($(compgen -W '" + join(option->choices, " ") +
               "' -- \"$word\")); return ;;\n";
    }
  }
  return function + "() {\n  local word=\"${COMP_WORDS[COMP_CWORD]}\"\n  case \"${COMP_WORDS[COMP_CWORD-1]}\" in\n" +
         cases + "    --completion) COMPREPLY=($(compgen -W 'bash zsh fish' -- \"$word\")); return ;;\n  esac\n" +
         "  case \"$word\" in\n    -*) COMPREPLY=($(compgen -W '" + flags +
         "' -- \"$word\")) ;;\n    *) COMPREPLY=($(compgen -f" +
         (tool.subcommands.empty() ? "" : " -W '" + join(command_names(tool), " ") + "'") +
         " -- \"$word\")) ;;\n  esac\n}\n" + "complete -o filenames -F " + function + " " + tool.manual.name + "\n";
}

std::string zsh(const Declaration& tool) {
  std::string out = "#compdef " + tool.manual.name + "\n_arguments -s \\\n";
  for (const Option* option : completed_options(tool)) {
    std::string help;
    for (const char c : option->help)
      help += (c == '[' || c == ']' || c == ':') ? std::string("\\") + c : std::string(1, c);
    std::string spec = (option->repeatable ? "*" : "") + long_flag(*option) + "[" + help + "]";
    if (!option->choices.empty())
      spec += ":" + option->value_name + ":(" + join(option->choices, " ") + ")";
    else if (!option->value_name.empty())
      spec += (option->implicit.empty() ? ":" : "::") + option->value_name + ":_files";
    out += "  " + literal(spec) + " \\\n";
  }
  for (const auto& name : about_flags()) out += "  " + literal(name) + " \\\n";
  const std::string commands =
      tool.subcommands.empty() ? "" : "  " + literal("1:command:(" + join(command_names(tool), " ") + ")") + " \\\n";
  return out + commands + "  " + literal("*:file:_files") + "\n";
}

std::string fish(const Declaration& tool) {
  const std::string begin = "complete -c " + tool.manual.name;
  std::string out;
  for (const Option* option : completed_options(tool)) {
    out += begin + " -l " + long_flag(*option).substr(2) +
           (option->value_name.empty() || !option->implicit.empty() ? "" : " -r");
    if (!option->choices.empty()) out += " -f -a " + literal(join(option->choices, " "));
    out += " -d " + literal(option->help) + "\n";
  }
  for (const auto& nested : tool.subcommands) {
    out +=
        begin + " -n __fish_use_subcommand -a " + nested.manual.name + " -d " + literal(nested.manual.summary) + "\n";
  }
  for (const auto& name : about_flags()) out += begin + " -l " + name.substr(2) + "\n";
  return out;
}

}  // namespace

std::string completion(const Declaration& tool, const std::string& shell) {
  if (shell == "bash") return bash(tool);
  if (shell == "zsh") return zsh(tool);
  if (shell == "fish") return fish(tool);
  throw Error{Fault::usage, "--completion: '" + shell + "' is not one of bash, zsh, fish"};
}

}  // namespace vam::cli
