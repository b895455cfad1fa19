// What App collects: the one declaration from which help, manual and completions are printed.
#pragma once

#include <string>
#include <vector>

#include "cli/app.hpp"

namespace vam::cli {

struct Option {
  std::string flag;        // "--voxel"; "-o,--output"
  std::string value_name;  // "MM"; empty for a flag
  std::string help;
  std::string default_text;          // empty: none shown
  std::string range_text;            // "greater than 0"; empty: none shown
  std::vector<std::string> choices;  // empty: free text
  bool repeatable = false;
};

struct Group {
  std::string title;
  std::vector<Option> options;
};

struct Positional {
  std::string value_name;
  std::string help;
  bool many = false;
};

struct Declaration {
  Manual manual;
  std::vector<Positional> positionals;
  std::vector<Group> groups;
  std::vector<Declaration> subcommands;  // their manual has name and summary only
};

/// "--voxel" of "-v,--voxel".
[[nodiscard]] std::string long_flag(const Option& option);

[[nodiscard]] std::string help_text(const Declaration& tool);
[[nodiscard]] std::string manual_page(const Declaration& tool);  // mdoc(7)
[[nodiscard]] std::string completion(const Declaration& tool, const std::string& shell);

/// The texts that all tools share.
struct ExitStatus {
  int code;
  const char* meaning;
};
[[nodiscard]] const std::vector<ExitStatus>& exit_statuses();

}  // namespace vam::cli
