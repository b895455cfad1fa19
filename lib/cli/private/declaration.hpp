// SPDX-License-Identifier: GPL-3.0-or-later
// What App collects: the one declaration from which help, manual and completions are printed.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "cli/app.hpp"

namespace vam::cli {

/// Which options the user may give together.
struct Rule {
  std::string value;                    // of the option; empty: whatever it is
  bool excludes;                        // the conditions; else one of them must hold
  std::vector<std::string> conditions;  // "--grey-target": given; "--geometry vial": in force
};

struct Option {
  std::string flag;        // "--voxel"; "-o,--output"
  std::string value_name;  // "MM"; empty for a flag
  std::string help;
  std::string default_text;          // empty: none shown
  std::string range_text;            // "greater than 0"; empty: none shown
  std::vector<std::string> choices;  // empty: free text
  bool repeatable = false;
  std::string implicit = {};                // of the option without a number; empty: it must have a value
  std::vector<Rule> rules = {};             // where this one is given
  std::vector<std::string> not_for = {};    // kinds of input
  std::function<std::string()> value = {};  // in force
  bool required = false;                    // in its form of the tool,
  std::string unless = {};                  // unless this one is given
  bool form = false;                        // the synopsis shows the tool with it
  bool in_job = true;                       // App::job() lists it
  bool reads = false;                       // names a file that is read
  bool writes = false;                      // names a file that is written
  std::vector<std::string> endings = {};    // of which its name has one; empty: any
  bool any_name = false;                    // or it has none that says another format
  bool usual = false;                       // --help shows it where others need --help=all,
  std::string brief = {};                   // in these words; empty: in those of its first sentence
};

struct Group {
  std::string title;
  std::vector<Option> options;
};

struct Positional {
  std::string value_name;
  std::string help;
  std::string default_text;                               // empty: must be given
  std::function<std::vector<std::string>()> values = {};  // in force
  bool reads = false;                                     // names files that are read,
  std::vector<std::string> unless = {};                   // one of these options is given, which exclude it
};

struct Declaration {
  Manual manual;
  std::vector<Positional> positionals;
  std::vector<Group> groups;
  std::vector<Declaration> subcommands;  // their manual has name and summary only
};

/// The options that every tool has, beside those that print something and end.
[[nodiscard]] const std::vector<Option>& common_options();

/// "--voxel" of "-v,--voxel".
[[nodiscard]] std::string long_flag(const Option& option);

/// "MM", in brackets where it may be left out.
[[nodiscard]] std::string value_words(const Option& option);

/// The option of that name, of the tool itself or of one of its commands; null when there is none.
[[nodiscard]] const Option* find_option(const Declaration& tool, const std::string& flag);

/// Does the tool do something without a command? It does when it has operands or options beside its commands'.
[[nodiscard]] bool has_plain_form(const Declaration& tool);

[[nodiscard]] std::vector<Option> required_options(const Declaration& form);

/// The forms of the tool, or command, in its synopsis: as declared, and one for each option with form(): there it is
/// required, and the operands that it stands for are left out.
[[nodiscard]] std::vector<Declaration> forms_of(const Declaration& tool);

/// What help and manual say of the option: its help, choices, range, default. One sentence or more each.
[[nodiscard]] std::vector<std::string> details(const Option& option);
[[nodiscard]] std::string details(const Positional& positional);

/// "Requires --like.", "Not with --shown.", "Not for meshes.": what the option's rules are.
[[nodiscard]] std::vector<std::string> rule_texts(const Option& option);

/// Does --help leave options out?
[[nodiscard]] bool has_usual(const Declaration& tool);

/// all: also the options that are not usual, where some are.
[[nodiscard]] std::string help_text(const Declaration& tool, bool all);
/// mdoc(7): the tool's page, with what it declares between the marks `.\" <NAME>` and `.\" </NAME>`: name, synopsis,
/// options, environment, files, status, and its own lists.
[[nodiscard]] std::string printed_manual(const Declaration& tool);
[[nodiscard]] std::string completion(const Declaration& tool, const std::string& shell);

/// The exit statuses that the tool's manual lists: those of all tools, 1 with --require, and the tool's own.
[[nodiscard]] std::vector<ExitStatus> exit_statuses(const Declaration& tool);

}  // namespace vam::cli
