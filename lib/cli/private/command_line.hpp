// SPDX-License-Identifier: GPL-3.0-or-later
// Private to App: the words of a command line, seen by the declaration before they are parsed.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/log/log.hpp"
#include "cli/private/declaration.hpp"

namespace vam::cli {

[[nodiscard]] bool is_option(const std::string& word);

/// The flag of "--flag=value".
[[nodiscard]] std::string flag_of(const std::string& word);

/// --help and the others that print and end.
[[nodiscard]] const std::vector<std::string>& about_flags();

[[nodiscard]] std::vector<std::string> command_names(const Declaration& tool);

/// Where the command stands: the first word that is neither an option nor its value, when that is one. Else -1.
[[nodiscard]] int find_command(const Declaration& tool, const std::vector<std::string>& words);

/// Throws Fault::usage when a tool that does nothing without a command is not given one.
void require_command(const Declaration& tool, const std::vector<std::string>& words);

/// Options before the command go behind it, so that both orders mean the same.
void put_command_first(const Declaration& tool, std::vector<std::string>& words);

/// Puts the implicit values behind options that are given without one.
void add_implicit_values(const Declaration& tool, std::vector<std::string>& words);

/// The values of common_options().
struct CommonOptions {
  std::optional<std::string> memory_gib;  // as given
  LogOptions log;
};
inline constexpr const char* memory_flag = "--memory";

/// Takes the options that every tool has out of the words, so that they are not part of its history. Throws
/// Fault::usage where one is given twice, has no value or one that is not allowed.
[[nodiscard]] CommonOptions take_common_options(std::vector<std::string>& words);

/// The words but for these options of the tool, by their long flags, and their values.
[[nodiscard]] std::vector<std::string> words_without(const Declaration& tool, const std::vector<std::string>& words,
                                                     const std::vector<std::string>& flags);

/// The line for a word that the tool, or the command that the words name, does not know.
[[nodiscard]] std::string unknown_word(const Declaration& tool, const std::vector<std::string>& words,
                                       const std::string& unknown);

}  // namespace vam::cli
