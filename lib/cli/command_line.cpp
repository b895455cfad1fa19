// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/private/command_line.hpp"

#include <algorithm>

#include "base/error.hpp"
#include "base/text/text.hpp"

namespace vam::cli {

namespace {

bool has_name(const Option& option, const std::string& flag) {
  const auto names = split(option.flag, ',');
  return std::find(names.begin(), names.end(), flag) != names.end();
}

const Option* find_own(const Declaration& tool, const std::string& flag) {
  for (const auto& group : tool.groups) {
    for (const auto& option : group.options) {
      if (has_name(option, flag)) return &option;
    }
  }
  return nullptr;
}

// The command that the words name, else the tool's plain form.
const Declaration& form_of(const Declaration& tool, const std::vector<std::string>& words) {
  const int place = find_command(tool, words);
  if (place < 0) return tool;
  const auto& name = words[place];
  return *std::find_if(tool.subcommands.begin(), tool.subcommands.end(),
                       [&](const Declaration& nested) { return nested.manual.name == name; });
}

std::vector<std::string> flags_of(const Declaration& form) {
  std::vector<std::string> flags = about_flags();
  for (const Option& option : common_options()) flags.push_back(long_flag(option));
  for (const auto& group : form.groups) {
    for (const auto& option : group.options) flags.push_back(long_flag(option));
  }
  return flags;
}

// The forms of the tool that take an option: "move, spin".
std::string takers(const Declaration& tool, const std::string& flag) {
  std::vector<std::string> names;
  if (find_own(tool, flag) != nullptr) names.push_back(tool.manual.name + " without a command");
  for (const auto& nested : tool.subcommands) {
    if (find_own(nested, flag) != nullptr) names.push_back(nested.manual.name);
  }
  return join(names, ", ");
}

bool is_about(const std::string& flag) {
  return flag == "-h" || std::find(about_flags().begin(), about_flags().end(), flag) != about_flags().end();
}

// An option of the tool, its commands, or every tool.
const Option* find_of_any(const Declaration& tool, const std::string& flag) {
  const auto& of_all = common_options();
  const auto common =
      std::find_if(of_all.begin(), of_all.end(), [&](const auto& option) { return has_name(option, flag); });
  return common != of_all.end() ? &*common : find_option(tool, flag);
}

// Where the first word stands that is neither an option of the tool nor an option's value: an operand, or an option
// that is misspelt, as one cannot know whether it has a value; -1 when there is none.
int first_other(const Declaration& tool, const std::vector<std::string>& words) {
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (words[i] == "--") return -1;
    const std::string flag = flag_of(words[i]);
    const Option* option = find_of_any(tool, flag);
    const bool joined_short = is_option(words[i]) && words[i][1] != '-' && words[i].size() > 2;
    if (option == nullptr && !joined_short && !is_about(flag)) return static_cast<int>(i);
    if (option != nullptr && !option->value_name.empty() && flag == words[i]) ++i;  // its value
  }
  return -1;
}

}  // namespace

const std::vector<std::string>& about_flags() {
  static const std::vector<std::string> all{"--help", "--version", "--man", "--completion"};
  return all;
}

const Option* find_option(const Declaration& tool, const std::string& flag) {
  const Option* found = find_own(tool, flag);
  for (const auto& nested : tool.subcommands) {
    if (found == nullptr) found = find_own(nested, flag);
  }
  return found;
}

bool is_option(const std::string& word) { return word.size() > 1 && word[0] == '-'; }

std::string flag_of(const std::string& word) { return word.substr(0, word.find('=')); }

std::vector<std::string> command_names(const Declaration& tool) {
  std::vector<std::string> names;
  for (const auto& nested : tool.subcommands) names.push_back(nested.manual.name);
  return names;
}

int find_command(const Declaration& tool, const std::vector<std::string>& words) {
  const int place = first_other(tool, words);
  if (place < 0) return -1;
  const auto names = command_names(tool);
  return std::find(names.begin(), names.end(), words[place]) == names.end() ? -1 : place;
}

void require_command(const Declaration& tool, const std::vector<std::string>& words) {
  if (has_plain_form(tool) || find_command(tool, words) >= 0) return;
  const auto names = command_names(tool);
  const int place = first_other(tool, words);
  if (place < 0) throw Error{Fault::usage, "no command; give one of " + join(names, ", ")};
  const std::string& word = words[place];
  if (is_option(word)) throw Error{Fault::usage, unknown_word(tool, words, word)};
  throw Error{Fault::usage,
              word + ": unknown command" + did_you_mean(word, names) + " (" + tool.manual.name + " --help lists all)"};
}

void put_command_first(const Declaration& tool, std::vector<std::string>& words) {
  const int place = find_command(tool, words);
  if (place > 0) std::rotate(words.begin(), words.begin() + place, words.begin() + place + 1);
}

void add_implicit_values(const Declaration& tool, std::vector<std::string>& words) {
  const Declaration form = form_of(tool, words);
  for (std::size_t i = 0; i < words.size() && words[i] != "--"; ++i) {
    const Option* option = find_own(form, flag_of(words[i]));
    const bool joined = flag_of(words[i]) != words[i];
    if (option != nullptr && option->value_name.empty() && joined)
      throw Error{Fault::usage, long_flag(*option) + ": takes no value"};
    if (option == nullptr || option->value_name.empty() || joined) continue;
    if (option->implicit.empty()) {
      ++i;  // its value may look like an option
    } else if (i + 1 == words.size() || !parse_number(words[i + 1])) {
      words[i] += "=" + option->implicit;
    }
  }
}

std::vector<std::string> words_without(const Declaration& tool, const std::vector<std::string>& words,
                                       const std::vector<std::string>& flags) {
  std::vector<std::string> kept;
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (words[i] == "--") {
      kept.insert(kept.end(), words.begin() + static_cast<std::ptrdiff_t>(i), words.end());
      break;
    }
    const bool joined_short = is_option(words[i]) && words[i][1] != '-' && words[i].size() > 2;
    const std::string flag = joined_short ? words[i].substr(0, 2) : flag_of(words[i]);
    const Option* option = find_own(tool, flag);
    const bool has_value_behind = option != nullptr && !option->value_name.empty() && flag == words[i];
    const bool dropped = option != nullptr && std::find(flags.begin(), flags.end(), long_flag(*option)) != flags.end();
    if (!dropped) kept.push_back(words[i]);
    if (!has_value_behind || i + 1 == words.size()) continue;
    ++i;
    if (!dropped) kept.push_back(words[i]);
  }
  return kept;
}

std::string unknown_word(const Declaration& tool, const std::vector<std::string>& words, const std::string& unknown) {
  const Declaration& form = form_of(tool, words);
  const bool plain = &form == &tool;
  const std::string name = plain ? tool.manual.name : tool.manual.name + " " + form.manual.name;
  const std::string where = " (" + name + (has_usual(form) ? " --help=all" : " --help") + " lists all)";
  const auto end_of_options = std::find(words.begin(), words.end(), "--");
  if (is_option(unknown) && std::find(words.begin(), end_of_options, unknown) == end_of_options) {
    return unknown + ": unexpected argument after --; options come before it" + where;
  }
  if (!is_option(unknown)) {
    const auto known = plain ? command_names(tool) : std::vector<std::string>{};
    return unknown + ": unexpected argument" + did_you_mean(unknown, known) + where;
  }
  const std::string flag = flag_of(unknown);
  const std::string others = takers(tool, flag);
  if (!others.empty()) return flag + ": not an option of " + name + "; it belongs to " + others;
  std::vector<std::string> known = flags_of(form);
  for (const auto& nested : form.subcommands) {
    for (const auto& other : flags_of(nested)) known.push_back(other);
  }
  return flag + ": unknown option" + did_you_mean(flag, known) + where;
}

}  // namespace vam::cli
