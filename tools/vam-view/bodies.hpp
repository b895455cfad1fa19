// SPDX-License-Identifier: GPL-3.0-or-later
// Meshes, parts and prints as bodies.
#pragma once

#include <string>

#include "io/vdb/vdb.hpp"
#include "plot/image_figure.hpp"
#include "plot/view.hpp"

namespace vam::view_tool {

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

}  // namespace vam::view_tool
