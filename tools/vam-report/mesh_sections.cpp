// SPDX-License-Identifier: GPL-3.0-or-later
// Sections of meshes as drawings with dimensions.
#include <algorithm>
#include <array>
#include <cmath>

#include "base/index.hpp"
#include "base/text/text.hpp"
#include "plot/canvas.hpp"
#include "plot/page.hpp"
#include "solid/mesh/geometry.hpp"
#include "vam-report/meshes.hpp"

namespace vam::report_tool {

namespace {

using Point = std::array<double, 2>;

struct Outline {
  std::vector<std::array<Point, 2>> segments;
  Point low{1e300, 1e300};
  Point high{-1e300, -1e300};
  [[nodiscard]] double size(std::size_t axis) const { return high[axis] - low[axis]; }
};

// A plane across an axis; the drawing's axes are the other two, in order.
struct Cut {
  std::size_t across;
  double at_mm;
  [[nodiscard]] Point flat(const Vector3& p) const {
    return across == 0 ? Point{p[1], p[2]} : across == 1 ? Point{p[0], p[2]} : Point{p[0], p[1]};
  }
};

Outline outline_of(const model::TriangleSoup& mesh, const Cut& cut) {
  Outline found;
  for (const auto& triangle : mesh.triangles) {
    std::vector<Point> ends;
    for (std::size_t n = 0; n < 3; ++n) {
      const Vector3& a = mesh.points[triangle[n]];
      const Vector3& b = mesh.points[triangle[(n + 1) % 3]];
      const double from = a[cut.across] - cut.at_mm;
      const double to = b[cut.across] - cut.at_mm;
      if ((from < 0) == (to < 0)) continue;
      ends.push_back(cut.flat(a + (from / (from - to)) * (b - a)));
    }
    if (ends.size() != 2) continue;
    found.segments.push_back({ends[0], ends[1]});
    for (const Point& end : ends) {
      for (std::size_t k = 0; k < 2; ++k) {
        found.low[k] = std::min(found.low[k], end[k]);
        found.high[k] = std::max(found.high[k], end[k]);
      }
    }
  }
  return found;
}

/// Whether a face lies in the plane, or within so much of it, where the outline would be that of its ragged edge.
bool lies_in_a_face(const model::TriangleSoup& mesh, const Cut& cut, double near_mm) {
  constexpr double flat = 0.95;  // cosine
  return std::any_of(mesh.triangles.begin(), mesh.triangles.end(), [&](const auto& triangle) {
    const auto& [a, b, c] = triangle;
    const Vector3 normal = cross(mesh.points[b] - mesh.points[a], mesh.points[c] - mesh.points[a]);
    return std::abs(normal[cut.across]) > flat * length(normal) &&
           std::all_of(triangle.begin(), triangle.end(),
                       [&](int corner) { return std::abs(mesh.points[corner][cut.across] - cut.at_mm) < near_mm; });
  });
}

/// Through the middle, or beside it where faces lie there.
Cut cut_across(std::size_t axis, const solid::Bounds& box, const std::vector<ShownMesh>& meshes) {
  constexpr double near = 0.01;
  const double size = box.high[axis] - box.low[axis];
  const Cut middle{axis, 0.5 * (box.low[axis] + box.high[axis])};
  for (const double aside : {0.0, 0.03, -0.03, 0.06, -0.06, 0.1, -0.1}) {
    const Cut cut{axis, middle.at_mm + aside * size};
    const bool clear = std::none_of(meshes.begin(), meshes.end(), [&](const ShownMesh& shown) {
      return lies_in_a_face(shown.mesh, cut, near * size);
    });
    if (clear) return cut;
  }
  return middle;
}

constexpr double drawn_px = 360;
constexpr double margin_px = 60;

/// mm to pixels, upwards.
struct Sheet {
  Point low;
  Point high;
  double scale;
  [[nodiscard]] plot::Spot at(const Point& mm) const {
    return {margin_px + (mm[0] - low[0]) * scale, 0.5 * margin_px + (high[1] - mm[1]) * scale};
  }
};

Sheet sheet_around(const std::vector<Outline>& outlines) {
  Sheet sheet{outlines[0].low, outlines[0].high, 1};
  for (const Outline& outline : outlines) {
    for (std::size_t k = 0; k < 2 && !outline.segments.empty(); ++k) {
      sheet.low[k] = std::min(sheet.low[k], outline.low[k]);
      sheet.high[k] = std::max(sheet.high[k], outline.high[k]);
    }
  }
  sheet.scale = drawn_px / std::max({sheet.high[0] - sheet.low[0], sheet.high[1] - sheet.low[1], 1e-9});
  return sheet;
}

using Errors = std::optional<DimensionErrors>;

std::string words(const std::vector<Outline>& outlines, std::size_t axis, const Errors& errors) {
  const double size_mm = outlines[0].size(axis);
  std::string text = format_number(size_mm, 5);
  if (errors) text += " \u00b1 " + format_number(errors->expanded_mm(size_mm), 2);
  text += " mm";
  if (outlines.size() > 1) text += " (design " + format_number(outlines[1].size(axis), 5) + " mm)";
  return text;
}

std::string drawing(const std::vector<Outline>& outlines, const Errors& errors) {
  const Sheet sheet = sheet_around(outlines);
  const plot::Spot end = sheet.at({sheet.high[0], sheet.low[1]});
  plot::Canvas canvas(round_int(std::max(end.x, margin_px + 160) + 0.5 * margin_px),
                      round_int(std::max(end.y, 0.5 * margin_px + 160) + margin_px));
  for (std::size_t n = outlines.size(); n-- > 0;) {
    std::vector<plot::SpotPair> lines;
    for (const auto& [from, to] : outlines[n].segments) lines.emplace_back(sheet.at(from), sheet.at(to));
    canvas.lines(lines, n == 0 ? plot::paint::blue : plot::paint::grey, 1.5);
  }
  // The extent of the first outline, below it and on its left.
  const auto [left, bottom] = sheet.at(outlines[0].low);
  const auto [right, top] = sheet.at(outlines[0].high);
  const double below = end.y + 14;
  constexpr double beside = margin_px - 16;
  constexpr double tick = 5;
  canvas.lines({{{left, below}, {right, below}},
                {{left, below - tick}, {left, below + tick}},
                {{right, below - tick}, {right, below + tick}},
                {{beside, top}, {beside, bottom}},
                {{beside - tick, top}, {beside + tick, top}},
                {{beside - tick, bottom}, {beside + tick, bottom}}},
               plot::paint::black);
  const std::string across = words(outlines, 0, errors);
  const std::string upwards = words(outlines, 1, errors);
  constexpr double size = 12;
  canvas.text({0.5 * (left + right), below + 8}, across, size, plot::paint::black, plot::Align::middle);
  canvas.text({beside - 8, 0.5 * (top + bottom)}, upwards, size, plot::paint::black, plot::Align::middle,
              plot::Align::end, true);
  return plot::page_image(canvas.image(2 * plot::screen_dpi), across + " wide, " + upwards + " high");
}

std::string caption(const std::vector<ShownMesh>& meshes, std::size_t outlines, const Errors& errors) {
  const std::string lines =
      outlines > 1 ? "Blue: " + meshes[0].name + "; grey: " + meshes[1].name + "." : "Dimensions of the section.";
  return lines + (errors ? " Dimensions have expanded uncertainties, k = 2." : "");
}

}  // namespace

std::string mesh_sections(const std::vector<ShownMesh>& meshes, const std::optional<DimensionErrors>& errors) {
  if (meshes.empty()) return "";
  constexpr std::array<const char*, 3> names{"x", "y", "z"};
  const solid::Bounds box = solid::bounding_box(meshes[0].mesh);
  std::string made;
  for (std::size_t axis = 3; axis-- > 0;) {
    const Cut cut = cut_across(axis, box, meshes);
    std::vector<Outline> outlines;
    for (const ShownMesh& mesh : meshes) outlines.push_back(outline_of(mesh.mesh, cut));
    if (outlines[0].segments.empty()) continue;
    outlines.resize(std::min<std::size_t>(outlines.size(), 2));
    if (outlines.size() > 1 && outlines[1].segments.empty()) outlines.pop_back();
    const std::string where =
        std::string("section across ") + names[axis] + " at " + format_number(cut.at_mm, 4) + " mm";
    made += plot::page_figure(meshes[0].name + ", " + where, drawing(outlines, errors),
                              caption(meshes, outlines.size(), errors));
  }
  return made;
}

}  // namespace vam::report_tool
