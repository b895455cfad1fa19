// SPDX-License-Identifier: GPL-3.0-or-later
#include "vam-report/page_parts.hpp"

#include "base/text/json.hpp"
#include "plot/page.hpp"

namespace vam::report_tool {

std::string page_data(const Json& values) {
  std::string text;
  for (const char letter : values.dump(-1, ' ', true, Json::error_handler_t::replace)) {
    if (letter == '<') {
      text += "\\u003c";
    } else {
      text += letter;
    }
  }
  return "<script type=\"application/json\">" + text + "</script>";
}

const char* const page_style = R"css(
figure.wide{width:62em}.control{display:flex;gap:.6em;align-items:center;margin:.2em 0}.control input{flex:1}
.control output{min-width:8em;font-variant-numeric:tabular-nums}.verdict{padding:.5em .8em;border-left:.5em solid #888;
background:#f4f4f4;font-size:1.1em}.verdict.good{border-color:#0072b2}.verdict.bad{border-color:#d55e00}
canvas{width:100%;aspect-ratio:4/3;border:1px solid #ccc;touch-action:none;cursor:grab}
.scale span:last-child{display:block}.scale i{display:inline-block;width:12em;height:.9em;border:1px solid #888;margin:0 .5em;
vertical-align:middle}
details{margin:.3em 0}summary{cursor:pointer;font-weight:600}
.wrapped{overflow-x:auto}code{font-size:.9em;overflow-wrap:anywhere}h2{break-after:avoid}
@media(prefers-color-scheme:dark){.verdict{background:#2a2a2a}}
@media print{.control,summary::marker{display:none}figure{break-inside:avoid}body{font-size:11px}}
)css";

std::string series(const std::string& title, const std::vector<Frame>& frames, const std::string& caption, bool plays) {
  if (frames.empty()) return "";
  const std::size_t middle = frames.size() / 2;
  const Frame& first = frames[middle];
  const std::string seen = plot::page_image(first.image, title);
  if (frames.size() == 1) return plot::page_figure(title, seen, caption);
  Json all = Json::array();
  for (const Frame& frame : frames) all.push_back({frame.label, plot::page_png(frame.image)});
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
