// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>

#include "base/text/printable.hpp"
#include "base/text/text.hpp"
#include "plot/axis.hpp"
#include "plot/colour_map.hpp"
#include "plot/image_figure.hpp"
#include "plot/page.hpp"
#include "vam-status/page.hpp"

namespace vam::status_tool {

namespace {

std::string mm(double value) { return format_number(value, 4); }

std::string element(const std::string& name, const std::string& attributes, const std::string& content = "") {
  return "<" + name + " " + attributes + ">" + content + "</" + name + ">";
}

std::string label_at(double x, double y, const std::string& attributes, const std::string& words) {
  return element("text", "x=\"" + mm(x) + "\" y=\"" + mm(y) + "\" " + attributes, page_text(words));
}

// Ticks of both axes at the left and lower edge of a square of this half side; y runs down on the page, up in the lab.
std::string axes(double half, double size) {
  std::string drawn = element("rect", "x=\"" + mm(-half) + "\" y=\"" + mm(-half) + "\" width=\"" + mm(2 * half) +
                                          "\" height=\"" + mm(2 * half) + "\" class=\"line\"");
  for (const double at : plot::ticks({"", -half, half}, 6)) {
    const std::string label = plot::tick_label(at);
    drawn += element("path", "d=\"M" + mm(at) + " " + mm(half) + "v" + mm(0.3 * size) + "M" + mm(-half) + " " +
                                 mm(-at) + "h" + mm(-0.3 * size) + "\" class=\"line\"");
    drawn += label_at(at, half + 1.4 * size, "text-anchor=\"middle\"", label);
    drawn += label_at(-half - 0.5 * size, -at + 0.35 * size, "text-anchor=\"end\"", label);
  }
  drawn += label_at(0, half + 2.9 * size, "text-anchor=\"middle\"", "x (mm)");
  return drawn + element("g", "transform=\"translate(" + mm(-half - 2.7 * size) + ",0) rotate(-90)\"",
                         label_at(0, 0, "text-anchor=\"middle\"", "y (mm)"));
}

// The middle row of the image as a profile at the lower edge, as high as it is bright.
std::string beam_profile(const std::vector<float>& values, double half_width, double base, double height) {
  const auto count = static_cast<double>(values.size());
  std::string points = mm(-half_width) + "," + mm(base) + " ";
  const std::size_t step = std::max<std::size_t>(1, values.size() / 400);
  for (std::size_t i = 0; i < values.size(); i += step) {
    const double x = (static_cast<double>(i) + 0.5 - 0.5 * count) / count * 2 * half_width;
    points += mm(x) + "," + mm(base - height * values[i]) + " ";
  }
  return element("polygon", "points=\"" + points + mm(half_width) + "," + mm(base) + "\" class=\"beam\"");
}

std::string arrow(double x, double from, double to, double size) {
  return element("path", "d=\"M" + mm(x) + " " + mm(from) + "V" + mm(to) + "m" + mm(-0.4 * size) + " " +
                             mm(0.7 * size) + "l" + mm(0.4 * size) + " " + mm(-0.7 * size) + "l" + mm(0.4 * size) +
                             " " + mm(0.7 * size) + "\" class=\"line ray\"");
}

// The bar of dose colours, from 0 to `high`.
std::string colour_bar(double high, const std::string& unit) {
  return "<div style=\"height:.8em;background:" + plot::page_gradient(plot::ColourMap::viridis, 8) +
         "\"></div><div style=\"display:flex;justify-content:space-between\"><span>0</span><span>" +
         format_number(high, 3) + " " + page_text(unit) + "</span></div>";
}

/// The vial and the dose in it, up to `high`, from above; with the light, where it is on.
std::string drawing_of(const RunFolder& run, const LightView& light, bool lit, double high) {
  const PrintProgress& progress = run.progress();
  const model::Printer& printer = run.printer();
  const double resin = light.resin_mm();
  const double vial = printer.vial.radius_mm;
  const double half = 1.35 * vial;
  const double size = 0.11 * vial;  // of letters
  const Image dose = light.dose(run.shown());
  const std::string png = plot::page_png(plot::coloured(dose, {plot::ColourMap::viridis, 0, high, ""}));
  // The stage turns the vial clockwise, seen from above, which is what a positive angle is to SVG.
  const std::string turned = mm(std::fmod(progress.angle_deg, 360) * printer.stage.direction);
  const std::string radius = mm(resin);
  std::string part =
      element("image", "href=\"data:image/png;base64," + png + "\" x=\"-" + radius + "\" y=\"-" + radius +
                           "\" width=\"" + mm(2 * resin) + "\" height=\"" + mm(2 * resin) + "\" clip-path=\"circle(" +
                           radius + "px at " + radius + "px " + radius + "px)\"");
  part += element(
      "path", "d=\"M" + mm(vial) + " 0l" + mm(size) + " " + mm(-0.5 * size) + "v" + mm(size) + "z\" class=\"mark\"");
  std::string drawing = element("g", "transform=\"rotate(" + turned + ")\"", part);
  drawing += element("circle", "r=\"" + mm(vial) + "\" class=\"line\"");
  drawing += axes(half, size);
  if (lit) {
    drawing += beam_profile(light.beam(progress.angle_deg), light.half_width_mm(), half, 0.28 * vial);
    for (const double x : {-0.3, 0.0, 0.3}) drawing += arrow(x * vial, half - 0.02 * vial, 1.06 * vial, size);
  }
  drawing += label_at(0, -half + 1.2 * size, "text-anchor=\"middle\"", lit ? "light comes from below" : "no light");
  const double left = half + 4 * size;
  return "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"" + mm(-left) + " " + mm(-half - 0.5 * size) + " " +
         mm(left + half + 0.5 * size) + " " + mm(2 * half + 4 * size) +
         "\" role=\"img\" aria-label=\"vial from above\"><style>.line{fill:none;"
         "stroke:#333;stroke-width:" +
         mm(0.09 * size) +
         "}.ray{stroke:#c60}.beam{fill:#f90;"
         "fill-opacity:.55}.mark{fill:#c00}text{font-size:" +
         mm(size) + "px}</style>" + drawing + "</svg>";
}

}  // namespace

std::string overhead_figure(const RunFolder& run, const LightView& light, bool lit) {
  const double high = light.full_dose() * std::max(1.0, run.progress().turns);
  const std::string unit = light.absolute() ? "mJ/cm3" : "of the maximum dose of a turn";
  const auto& critical = run.printer().resin.critical_dose_mj_cm3;
  const std::string gels =
      light.absolute() && critical ? " The resin gels at " + format_number(*critical, 3) + " mJ/cm3." : "";
  return "<figure><h2>Vial from above: dose so far</h2>" + drawing_of(run, light, lit, high) + colour_bar(high, unit) +
         "<figcaption>Slice at z = " + format_number(light.middle_mm(), 3) + " mm." + gels +
         " The red mark is stage angle 0 and turns with the vial; the profile below is the projected intensity in that "
         "slice." +
         (run.renewed() ? " The dose of the projections that took the place of the first ones is not shown." : "") +
         "</figcaption></figure>\n";
}

}  // namespace vam::status_tool
