// SPDX-License-Identifier: GPL-3.0-or-later
// Parts of a page: names, verdicts, values for its script, and images of which one is seen at a time.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/pixels.hpp"
#include "base/text/json_fwd.hpp"
#include "base/text/printable.hpp"
#include "plot/image_figure.hpp"

namespace vam::report_tool {

/// Without its folder: a report is read elsewhere.
inline std::string file_name(const std::string& path) { return std::filesystem::path(path).filename().string(); }

inline std::string verdict(bool good, const std::string& words) {
  return "<p class=\"verdict " + std::string(good ? "good" : "bad") + "\">" + page_text(words) + "</p>\n";
}

/// A data block that no browser runs. Every < is escaped, so that no text in it can end it.
[[nodiscard]] std::string page_data(const Json& values);

extern const char* const page_script;
extern const char* const page_style;

struct Frame {
  std::string label;  // "z = 1.5 mm"
  RgbImage image;
};

/// HTML: a slider moves through them. The middle one is seen first, and printed. With `plays` there is a button that
/// shows one after the other.
[[nodiscard]] std::string series(const std::string& title, const std::vector<Frame>& frames, const std::string& caption,
                                 bool plays = false);

/// Each panel of a sheet as a figure with axes, in the colours of all of them.
[[nodiscard]] std::vector<Frame> frames_of(const plot::ImageFigure& sheet);

}  // namespace vam::report_tool
