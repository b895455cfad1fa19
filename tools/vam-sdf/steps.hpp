// SPDX-License-Identifier: GPL-3.0-or-later
// The steps of an inspection, print against design.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "metrology/compare/inspection.hpp"
#include "metrology/cure/bodies.hpp"
#include "model/mesh.hpp"
#include "solid/mesh/align.hpp"
#include "vam-sdf/options.hpp"

namespace vam::sdf_tool {

struct Toleranced {
  std::optional<double> tolerance_mm;      // of the whole print
  std::vector<metrology::Region> regions;  // each with its own tolerance, or that of the whole print
};

/// --region and --tolerance; the faces of regions are read. Throws Fault::usage when a name is given twice or not at
/// all, or a tolerance is not a length above 0.
[[nodiscard]] Toleranced read_regions(const Options& options);

/// Names of figures in conditions and messages: "rms", ..., and "top.flatness" of every region.
[[nodiscard]] std::vector<std::string> figure_names(const std::vector<metrology::Region>& regions);

/// Where the report has a figure, as a JSON pointer: "/regions/top/flatness_mm".
[[nodiscard]] std::string place_of(const std::string& name);

/// A print: without the bodies that are too small to belong to it (metrology::keep_bodies), which are counted; a mesh
/// stays as it is.
struct PrintSurface {
  model::TriangleSoup mesh;
  std::vector<float> uncertainty_mm;  // standard, of each vertex along the normal; empty: not known
  double mm_per_isovalue = 0;         // how far the surface moves with the isovalue; 0: a mesh
  std::optional<metrology::BodyCount> bodies;
};
[[nodiscard]] PrintSurface read_print(const cli::App& app, const Options& options, std::optional<double> isovalue);

/// Aligns by --align, then --datum; the print's points are moved. Throws Fault::data for a part that fits in two
/// places, and what find_region() throws.
[[nodiscard]] solid::Alignment align_print(const Options& options, const std::vector<metrology::Region>& regions,
                                           const model::TriangleSoup& design_mesh, const solid::Surface& design,
                                           model::TriangleSoup& print);

/// The deviation around the design's surface as a volume, for vam-slice --compensate. `print` is aligned.
void write_deviation_volume(const cli::App& app, const Options& options, const model::TriangleSoup& print,
                            const model::TriangleSoup& design, double rms_mm);

}  // namespace vam::sdf_tool
