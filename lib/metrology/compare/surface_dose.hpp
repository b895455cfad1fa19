// SPDX-License-Identifier: GPL-3.0-or-later
// The dose on the surface of a print: that with which the resin gelled there.
#pragma once

#include <string>

#include "base/stats/measured.hpp"
#include "base/text/json_fwd.hpp"
#include "model/grid.hpp"
#include "model/mesh.hpp"

namespace vam::metrology {

/// It differs from the dose with which the resin gels inside a part, as inhibitor diffuses from the resin that is left
/// dark to the surface [physics §14.7].
struct SurfaceDose {
  stats::Measured critical_dose_mj_cm3;  // median; its sigma is from the medians of eight parts of the surface
  double spread_mj_cm3 = 0;              // standard deviation over the surface, by the median deviation
  double gradient_mj_cm3_mm = 0;         // median slope of the dose there: by it a surface moves with the dose
};

/// `body` in the part's frame and mm; `dose` in mJ/cm3, total, its heights those of the part times stretch_z.
/// Throws Fault::data, naming `subject`, where the body has no surface, or more than a tenth of it lies beyond the
/// dose.
[[nodiscard]] SurfaceDose surface_dose(const model::TriangleSoup& body, const model::Volume& dose, double stretch_z,
                                       const std::string& subject);

[[nodiscard]] Json to_json(const SurfaceDose& result);

}  // namespace vam::metrology
