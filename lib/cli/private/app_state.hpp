// SPDX-License-Identifier: GPL-3.0-or-later
// What an App holds between its declaration and its run.
#pragma once

#include <algorithm>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "cli/private/declaration.hpp"

namespace CLI {
class App;
}

namespace vam::cli {

struct App::State {
  Declaration tool;
  CLI::App* parser = nullptr;
  std::unique_ptr<CLI::App> owned;                // the root's parser
  std::vector<std::unique_ptr<App>> subcommands;  // declared under this one
  std::function<void()> body;                     // of a subcommand
  std::vector<std::string> words;                 // of the history
  std::string heading = App::plain_heading;       // of the options that follow,
  std::vector<std::string> only_with, not_for;    // and their rules
  bool operand_last = false;                      // what was declared last is an operand

  Group& current_group() {
    const auto found = std::find_if(tool.groups.begin(), tool.groups.end(),
                                    [this](const Group& group) { return group.title == heading; });
    if (found != tool.groups.end()) return *found;
    tool.groups.push_back({heading, {}});
    return tool.groups.back();
  }
  /// With the rules of its group.
  void add(Option option) {
    const auto names_it = [&](const std::string& condition) {
      return (condition + ' ').starts_with(long_flag(option) + ' ');
    };
    if (!only_with.empty() && std::none_of(only_with.begin(), only_with.end(), names_it))
      option.rules.push_back({"", false, only_with});
    option.not_for = not_for;
    current_group().options.push_back(std::move(option));
  }
};

}  // namespace vam::cli
