// SPDX-License-Identifier: GPL-3.0-or-later
// What vam-view draws: bodies seen from one place in one scale, the print as it grows, and traces.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/vector3.hpp"
#include "io/vdb/vdb.hpp"
#include "plot/image_figure.hpp"
#include "plot/plot.hpp"
#include "plot/render.hpp"
#include "plot/view.hpp"
#include "solid/mesh/geometry.hpp"
#include "vam-view/options.hpp"

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

/// A mesh in its colours, or grey.
[[nodiscard]] plot::ImageFigure mesh_figure(const std::string& path, const plot::ViewOptions& view);

/// The surface of a volume at a level, and the insert, if any.
[[nodiscard]] plot::ImageFigure body_figure(const io::SparseVolume& volume, double level, const plot::ViewOptions& view,
                                            const io::SparseVolume* insert);

/// The target, and beside it what a dose prints at the threshold: where its surface is more than a voxel outside the
/// target, and where the target's is as far outside the print, in colours; the insert, if any, in both. Throws
/// Fault::data where nothing prints.
[[nodiscard]] plot::ImageFigure print_figure(const io::SparseVolume& dose, const io::SparseVolume& target,
                                             double threshold, const plot::ViewOptions& view,
                                             const io::SparseVolume* insert);

/// What prints of the dose of the whole exposure, and when: after the fraction f of the exposure what has the dose
/// threshold / f. The time is told in turns and seconds where they are known, else in per cent.
struct Exposure {
  struct Duration {
    double turns = 0;
    double seconds = 0;
  };
  double threshold = 0;
  std::optional<Duration> duration;
};

/// Six seconds from where the first resin gels to the end of the exposure, which stands for one more: the target, and
/// beside it the print so far, both with the insert, if any. Memory: the surfaces of eight frames. Throws Fault::data
/// where nothing prints, and as io::VideoWriter does.
void write_movie(const std::string& path, const io::SparseVolume& dose, const io::SparseVolume& target,
                 const io::SparseVolume* insert, const Exposure& exposure, const plot::ViewOptions& view, double dpi,
                 const std::string& history);

/// Of the input, and of a trace also that of --compare.
[[nodiscard]] plot::Plot trace_plot(const Options& options);

}  // namespace vam::view_tool
