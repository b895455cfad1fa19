// SPDX-License-Identifier: GPL-3.0-or-later
// Names of files on a page.
#pragma once

#include <filesystem>
#include <string>

namespace vam::report_tool {

/// Without its folder: a report is read elsewhere.
inline std::string file_name(const std::string& path) { return std::filesystem::path(path).filename().string(); }

}  // namespace vam::report_tool
