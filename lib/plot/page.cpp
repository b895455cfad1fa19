// SPDX-License-Identifier: GPL-3.0-or-later
#include "plot/page.hpp"

#include <string_view>

#include "base/sha256.hpp"
#include "base/text/base64.hpp"
#include "base/text/printable.hpp"
#include "io/image/image_file.hpp"

namespace vam::plot {

namespace {

constexpr const char* common_style =
    "body{font:15px/1.4 sans-serif;margin:1.2em;color:#111;background:#fff}h1{font-size:1.3em;margin:0}"
    "h2{font-size:1em;margin:0 0 .4em}p{margin:.3em 0 .8em}.images{display:flex;flex-wrap:wrap;gap:1.2em}"
    "figure{margin:0 0 1.2em;width:30em;max-width:100%}figure img,figure svg{width:100%;height:auto}"
    "figcaption{color:#444}table{border-collapse:collapse;margin:.4em 0 1em}"
    "th,td{text-align:left;padding:.15em 1em .15em 0;font-variant-numeric:tabular-nums}th{font-weight:600}"
    ".none{color:#666}";

/// "sha256-...": how a policy names the one script that may run (CSP level 3, section 2.3.1).
std::string script_source(const std::string& script) {
  const std::string digits = sha256(script);
  std::string bytes;
  for (std::size_t i = 0; i < digits.size(); i += 2)
    bytes += static_cast<char>(std::stoi(digits.substr(i, 2), nullptr, 16));
  return "'sha256-" + base64(bytes) + "'";
}

}  // namespace

std::string page_image(const RgbImage& image, const std::string& alt) {
  return "<img src=\"data:image/png;base64," + base64(io::encode_png(image)) + "\" alt=\"" + page_text(alt) + "\">";
}

std::string page_plot(Plot plot, const std::string& alt) {
  plot.width = 540;
  plot.height = 400;
  return page_image(draw(plot).image(), alt);
}

std::string page_gradient(ColourMap map, int steps) {
  std::string stops = "linear-gradient(90deg";
  for (int n = 0; n <= steps; ++n) {
    const Rgb c = colour(map, static_cast<double>(n) / steps);
    stops += ",rgb(" + std::to_string(c[0]) + "," + std::to_string(c[1]) + "," + std::to_string(c[2]) + ")";
  }
  return stops + ")";
}

std::string page_figure(const std::string& title, const std::string& content, const std::string& caption) {
  return "<figure><h2>" + page_text(title) + "</h2>" + content + "<figcaption>" + page_text(caption) +
         "</figcaption></figure>\n";
}

std::string html(const Page& page) {
  return "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n"
         "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
         "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; img-src data:; "
         "style-src 'unsafe-inline'; script-src " +
         script_source(page.script) + "\">\n" + page.head + "<title>" + page_text(page.title) + "</title>\n<style>" +
         common_style + page.style + "</style></head>\n<body" +
         (page.body_attributes.empty() ? "" : " " + page.body_attributes) + ">\n" + page.body + "<script>" +
         page.script + "</script></body></html>\n";
}

}  // namespace vam::plot
