// SPDX-License-Identifier: GPL-3.0-or-later
#include "vam-report/series.hpp"

#include "base/text/base64.hpp"
#include "base/text/json.hpp"
#include "base/text/printable.hpp"
#include "io/image/image_file.hpp"
#include "plot/page.hpp"
#include "vam-report/page_data.hpp"

namespace vam::report_tool {

std::string series(const std::string& title, const std::vector<Frame>& frames, const std::string& caption, bool plays) {
  if (frames.empty()) return "";
  const std::size_t middle = frames.size() / 2;
  const Frame& first = frames[middle];
  const std::string seen = plot::page_image(first.image, title);
  if (frames.size() == 1) return plot::page_figure(title, seen, caption);
  Json all = Json::array();
  for (const Frame& frame : frames) all.push_back({frame.label, base64(io::encode_png(frame.image))});
  std::string content = seen + "<div class=\"control\">";
  if (plays) content += "<button type=\"button\">play</button>";
  content += "<input type=\"range\" min=\"0\" max=\"" + std::to_string(frames.size() - 1) + "\" value=\"" +
             std::to_string(middle) + "\" aria-label=\"" + page_text(title) + "\"><output>" + page_text(first.label) +
             "</output></div>";
  return plot::page_figure(title, "<div class=\"series\">" + content + page_data(all) + "</div>", caption);
}

std::vector<Frame> frames_of(const plot::ImageFigure& sheet) {
  std::vector<Frame> frames;
  for (const plot::Panel& panel : sheet.panels) {
    plot::ImageFigure one = sheet;
    one.panels = {panel};
    one.title = panel.caption;
    frames.push_back({panel.caption, plot::draw(one).image()});
  }
  return frames;
}

}  // namespace vam::report_tool
