// SPDX-License-Identifier: GPL-3.0-or-later
#include "metrology/compare/emboss.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/constants.hpp"
#include "base/error.hpp"
#include "base/stats/median.hpp"
#include "base/text/json.hpp"
#include "base/text/text.hpp"
#include "metrology/compare/private/outline.hpp"

namespace vam::metrology {

namespace {

// Heights above the base; the base itself where there is no material.
struct Design {
  Image above_base_mm;
  double pixel_mm = 0;
  double height_mm = 0;
  std::vector<OutlinePoint> outline;  // mm about the middle, at half height
};

Design design_of(const solid::HeightMap& map) {
  const auto found = plateaus(map.heights_mm.values);
  if (!found) throw Error{Fault::data, "design: flat, no embossing; include the base plate"};
  Design design{map.heights_mm, map.pixel_mm, found->top_mm - found->base_mm, {}};
  for (float& h : design.above_base_mm.values) h = std::isnan(h) ? 0.0F : h - static_cast<float>(found->base_mm);
  const Image& image = design.above_base_mm;
  const auto half = static_cast<float>(0.5 * design.height_mm);
  const OutlinePoint middle = image_middle(image);
  const auto add = [&](int i, int j, int di, int dj) {
    const float from = image(i, j);
    const float to = image(i + di, j + dj);
    if ((from >= half) == (to >= half)) return;
    const auto part = static_cast<double>((half - from) / (to - from));
    design.outline.push_back({(i + part * di - middle.x) * map.pixel_mm, (middle.y - j - part * dj) * map.pixel_mm});
  };
  for (int j = 0; j + 1 < image.height; ++j) {
    for (int i = 0; i + 1 < image.width; ++i) {
      add(i, j, 1, 0);
      add(i, j, 0, 1);
    }
  }
  return design;
}

OutlinePoint centroid_above(const Image& image, double pixel_mm, float level) {
  const OutlinePoint middle = image_middle(image);
  OutlinePoint sum;
  double count = 0;
  for (int j = 0; j < image.height; ++j) {
    for (int i = 0; i < image.width; ++i) {
      if (image(i, j) < level) continue;
      sum.x += (i - middle.x) * pixel_mm;
      sum.y += (middle.y - j) * pixel_mm;
      count += 1;
    }
  }
  return {sum.x / std::max(count, 1.0), sum.y / std::max(count, 1.0)};
}

Similar place(const Design& design, const Relief& print, const Outline& outline, EmbossAlign align) {
  if (align == EmbossAlign::none) return {};
  const OutlinePoint from =
      centroid_above(design.above_base_mm, design.pixel_mm, static_cast<float>(0.5 * design.height_mm));
  const OutlinePoint to = centroid_above(print.heights_mm, print.pixel_mm, static_cast<float>(0.5 * print.plateau_mm));
  std::vector<OutlinePoint> few;
  const std::size_t stride = 1 + design.outline.size() / 500;
  for (std::size_t i = 0; i < design.outline.size(); i += stride) few.push_back(design.outline[i]);
  constexpr int turns = 24;
  Similar best;
  double best_rms = 1e300;
  for (int turn = 0; turn < (align == EmbossAlign::any_turn ? turns : 1); ++turn) {
    const double angle = 2 * std::numbers::pi * turn / turns;
    Similar start{std::cos(angle), std::sin(angle), 0, 0};
    const OutlinePoint there = start(from);
    start.x = to.x - there.x;
    start.y = to.y - there.y;
    const Similar found = fit_outline(few, outline, start, 30);
    const double rms = outline.rms(few, found);
    const double size = std::hypot(found.a, found.b);
    if (size < 0.5 || size > 2 || rms > 0.98 * best_rms) continue;  // of symmetric places the one with the least turn
    best = found;
    best_rms = rms;
  }
  return fit_outline(design.outline, outline, best, 50);
}

Image placed(const Design& design, const Similar& pose, const Relief& print) {
  Image image(print.heights_mm.width, print.heights_mm.height);
  const OutlinePoint middle = image_middle(image);
  const OutlinePoint design_middle = image_middle(design.above_base_mm);
  for (int j = 0; j < image.height; ++j) {
    for (int i = 0; i < image.width; ++i) {
      const OutlinePoint p = pose.inverse({(i - middle.x) * print.pixel_mm, (middle.y - j) * print.pixel_mm});
      image(i, j) = bilinear(design.above_base_mm, design_middle.x + p.x / design.pixel_mm,
                             design_middle.y - p.y / design.pixel_mm);
    }
  }
  return image;
}

// Overlap, and the height well inside the design's area.
void measure_area(const Relief& print, double margin_mm, Emboss& emboss) {
  const auto half_design = static_cast<float>(0.5 * emboss.design_height_mm);
  const auto half_print = static_cast<float>(0.5 * print.plateau_mm);
  const Image distance = distance_to(emboss.design, half_design);
  std::vector<double> heights;
  double both = 0;
  double either = 0;
  for (std::size_t i = 0; i < distance.size(); ++i) {
    if (print.measured.values[i] == 0) continue;
    const bool wanted = emboss.design.values[i] >= half_design;
    const bool there = print.heights_mm.values[i] >= half_print;
    both += wanted && there ? 1 : 0;
    either += wanted || there ? 1 : 0;
    if (static_cast<double>(distance.values[i]) * print.pixel_mm < -margin_mm)
      heights.push_back(static_cast<double>(print.heights_mm.values[i]));
  }
  emboss.iou = either > 0 ? both / either : 0;
  if (heights.empty()) {
    if (margin_mm > 0) measure_area(print, 0, emboss);
    return;
  }
  emboss.height_mm = stats::median(heights);
  emboss.height_sigma_mm = stats::robust_sigma(std::move(heights), emboss.height_mm);
}

}  // namespace

Emboss compare_emboss(const Relief& print, const solid::HeightMap& map, EmbossAlign align) {
  const Design design = design_of(map);
  const Outline outline(print);
  const Similar pose = place(design, print, outline, align);
  Emboss emboss;
  emboss.placing = {std::hypot(pose.a, pose.b), std::atan2(pose.b, pose.a) * deg_per_rad, pose.x, pose.y};
  emboss.design_height_mm = design.height_mm;
  double count = 0;
  for (const OutlinePoint& p : design.outline) {
    if (!outline.judges(pose(p))) continue;
    const double d = outline.distance(pose(p));
    count += 1;
    emboss.outline_mean_mm -= d;
    emboss.outline_max_mm = std::max(emboss.outline_max_mm, std::abs(d));
  }
  if (count == 0) throw Error{Fault::data, "design: its outline does not overlap the readings of the height image"};
  emboss.outline_mean_mm /= count;
  emboss.outline_rms_mm = outline.rms(design.outline, pose);
  emboss.design = placed(design, pose, print);
  constexpr double margin_mm = 0.15;  // edge blur of an image corrected for refraction [RAY21 fig 12]
  measure_area(print, margin_mm, emboss);
  if (emboss.iou == 0) throw Error{Fault::data, "design: does not overlap the embossing in the height image"};
  return emboss;
}

Section section(const Relief& print, const Emboss& emboss, double x0, double y0, double x1, double y1) {
  Section line;
  const double length_px = std::hypot(x1 - x0, y1 - y0);
  const int count = std::max(2, static_cast<int>(2 * length_px));
  for (int i = 0; i < count; ++i) {
    const double part = static_cast<double>(i) / (count - 1);
    const double x = x0 + part * (x1 - x0);
    const double y = y0 + part * (y1 - y0);
    line.along_mm.push_back(part * length_px * print.pixel_mm);
    const bool measured = bilinear(print.measured, x, y) > 0.999F;
    line.print_mm.push_back(measured ? static_cast<double>(bilinear(print.heights_mm, x, y)) : std::nan(""));
    line.design_mm.push_back(static_cast<double>(bilinear(emboss.design, x, y)));
  }
  return line;
}

Json to_json(const Relief& print, const Emboss& emboss) {
  const Placing& p = emboss.placing;
  return {{"shrinkage_percent", 100 * (1 - p.scale)},
          {"turn_deg", p.turn_deg},
          {"shift_mm", {p.shift_x_mm, p.shift_y_mm}},
          {"outline_rms_mm", emboss.outline_rms_mm},
          {"outline_mean_mm", emboss.outline_mean_mm},
          {"outline_max_mm", emboss.outline_max_mm},
          {"iou", emboss.iou},
          {"height_mm", emboss.height_mm},
          {"height_sigma_mm", emboss.height_sigma_mm},
          {"design_height_mm", emboss.design_height_mm},
          {"levelled_deg", print.tilt_deg}};
}

const std::vector<std::string>& emboss_names() {
  static const std::vector<std::string> names{"rms", "max", "iou", "shrinkage", "height"};
  return names;
}

double figure(const Emboss& emboss, const std::string& name) {
  if (name == "rms") return emboss.outline_rms_mm;
  if (name == "max") return emboss.outline_max_mm;
  if (name == "iou") return emboss.iou;
  if (name == "shrinkage") return 100 * (1 - emboss.placing.scale);
  return emboss.height_mm;
}

}  // namespace vam::metrology
