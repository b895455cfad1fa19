// SPDX-License-Identifier: GPL-3.0-or-later
// Where the print lies in its design.
#pragma once

#include <span>

#include "metrology/compare/inspection.hpp"
#include "model/mesh.hpp"
#include "solid/mesh/align.hpp"
#include "solid/mesh/signed_distance.hpp"
#include "vam-sdf/options.hpp"

namespace vam::sdf_tool {

/// Aligns by --align, then --datum; the print's points are moved. Throws Fault::data for a part that fits in two
/// places, and what find_region() throws.
[[nodiscard]] solid::Alignment align_print(const Options& options, const std::vector<metrology::Region>& regions,
                                           const model::TriangleSoup& design_mesh, const solid::Surface& design,
                                           model::TriangleSoup& print);

}  // namespace vam::sdf_tool
