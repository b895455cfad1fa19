// SPDX-License-Identifier: GPL-3.0-or-later
#include "plot/page.hpp"

#include <algorithm>
#include <cstdint>
#include <tuple>
#include <unordered_map>
#include <utility>
#include <vector>

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
    ".none{color:#666}@media(prefers-color-scheme:dark){body{background:#181818;color:#ddd}figcaption{color:#aaa}"
    ".none{color:#999}a{color:#8bd}}";

/// "sha256-...": how a policy names the one script that may run (CSP level 3, section 2.3.1).
std::string script_source(const std::string& script) {
  const std::string digits = sha256(script);
  std::string bytes;
  for (std::size_t i = 0; i < digits.size(); i += 2)
    bytes += static_cast<char>(std::stoi(digits.substr(i, 2), nullptr, 16));
  return "'sha256-" + base64(bytes) + "'";
}

/// Colours from `first` to before `last` of a list, which one colour stands for.
struct ColourBox {
  std::vector<Rgb>::iterator first, last;
  std::size_t channel = 0;  // the one of most extent
  int extent = 0;
  /// White, of the paper, stays white.
  [[nodiscard]] Rgb shown() const {
    return std::find(first, last, paint::white) != last ? paint::white : first[(last - first) / 2];
  }
};

ColourBox box_of(std::vector<Rgb>::iterator first, std::vector<Rgb>::iterator last) {
  ColourBox box{first, last};
  for (std::size_t channel = 0; channel < 3; ++channel) {
    const auto [low, high] =
        std::minmax_element(first, last, [&](const Rgb& a, const Rgb& b) { return a[channel] < b[channel]; });
    const int extent = (*high)[channel] - (*low)[channel];
    if (extent > box.extent) std::tie(box.channel, box.extent) = std::pair{channel, extent};
  }
  return box;
}

/// In at most 256 colours, a palette of which takes a third of the bytes: the colours are halved where they reach
/// furthest, until there are so many boxes of them (median cut).
RgbImage in_few_colours(RgbImage image) {
  constexpr std::size_t most = 256;
  std::vector<Rgb> colours = image.values;
  colours.erase(std::unique(colours.begin(), colours.end()), colours.end());  // most are their neighbour's
  std::sort(colours.begin(), colours.end());
  colours.erase(std::unique(colours.begin(), colours.end()), colours.end());
  if (colours.size() <= most) return image;
  std::vector<ColourBox> boxes{box_of(colours.begin(), colours.end())};
  while (boxes.size() < most) {
    const auto widest = std::max_element(boxes.begin(), boxes.end(),
                                         [](const ColourBox& a, const ColourBox& b) { return a.extent < b.extent; });
    const auto [first, last, channel, extent] = *widest;
    const auto half = first + (last - first) / 2;
    std::nth_element(first, half, last, [at = channel](const Rgb& a, const Rgb& b) { return a[at] < b[at]; });
    *widest = box_of(first, half);
    boxes.push_back(box_of(half, last));
  }
  std::unordered_map<std::uint32_t, Rgb> shown;
  const auto key = [](const Rgb& c) { return std::uint32_t{c[0]} << 16U | std::uint32_t{c[1]} << 8U | c[2]; };
  for (const ColourBox& box : boxes) {
    const Rgb colour = box.shown();
    for (auto at = box.first; at != box.last; ++at) shown[key(*at)] = colour;
  }
  for (Rgb& colour : image.values) colour = shown.at(key(colour));
  return image;
}

}  // namespace

std::string page_png(const RgbImage& image) { return base64(io::encode_indexed_png(in_few_colours(image))); }

std::string page_image(const RgbImage& image, const std::string& alt) {
  return "<img src=\"data:image/png;base64," + page_png(image) + "\" alt=\"" + page_text(alt) + "\">";
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
