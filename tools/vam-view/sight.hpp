// SPDX-License-Identifier: GPL-3.0-or-later
// Bodies in a figure: the surfaces of volumes, seen from one place in one scale.
#pragma once

#include <string>
#include <vector>

#include "base/vector3.hpp"
#include "io/vdb/vdb.hpp"
#include "plot/image_figure.hpp"
#include "plot/render.hpp"
#include "plot/view.hpp"
#include "solid/mesh/geometry.hpp"

namespace vam::view_tool {

/// What was in the vial before the print, in its own colour; without triangles for null.
[[nodiscard]] plot::Body insert_body(const io::SparseVolume* insert, const io::SparseVolume& part);

/// Its line of the legend, if it is there.
void name_insert(plot::ImageFigure& figure, const plot::Body& insert);

/// The square that holds the bodies from every side.
struct Sight {
  Vector3 centre{};
  double side_mm = 0;
};
[[nodiscard]] Sight sight_of(const std::vector<const plot::Body*>& bodies);

/// A square image of the bodies beside those that the figure has.
void add_panel(plot::ImageFigure& figure, const std::vector<const plot::Body*>& bodies, const Sight& sight, int pixels,
               const std::string& caption);

/// Axes and title: `what` after the name of the file, unless the title is given.
void label(plot::ImageFigure& figure, const Sight& sight, const plot::ViewOptions& view, const std::string& what);

/// "10 x 10 x 10 mm, z upwards, seen from 25° above".
[[nodiscard]] std::string size_text(const solid::Bounds& box);

}  // namespace vam::view_tool
