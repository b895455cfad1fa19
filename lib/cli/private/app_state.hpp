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
  std::string heading = App::plain_heading;       // of the options that follow
  bool operand_last = false;                      // what was declared last is an operand

  Group& current_group() {
    const auto found = std::find_if(tool.groups.begin(), tool.groups.end(),
                                    [this](const Group& group) { return group.title == heading; });
    if (found != tool.groups.end()) return *found;
    tool.groups.push_back({heading, {}});
    return tool.groups.back();
  }
};

}  // namespace vam::cli
