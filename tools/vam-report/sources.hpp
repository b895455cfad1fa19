// SPDX-License-Identifier: GPL-3.0-or-later
// The files that a report is made of.
#pragma once

#include <string>
#include <vector>

namespace vam::report_tool {

struct Sources {
  std::vector<std::string> volumes;  // OpenVDB
  std::vector<std::string> stacks;   // OpenEXR
  std::vector<std::string> videos;
  std::vector<std::string> reports;  // JSON objects
  std::vector<std::string> traces;   // CSV of vam-optimize --trace
  std::vector<std::string> images;   // PNG
  std::vector<std::string> meshes;
};

/// Each path is a file, or a folder whose files are taken in the order of their names, those of no use left out.
/// Throws Error: no_input; usage ("-"); data (a file that a report cannot show, a folder without any that it can).
[[nodiscard]] Sources gather(const std::vector<std::string>& paths);

}  // namespace vam::report_tool
