// SPDX-License-Identifier: GPL-3.0-or-later
// The expanded uncertainty of all figures of a print [GUM08; physics §8].
#pragma once

#include "base/text/json_fwd.hpp"
#include "metrology/compare/inspection.hpp"
#include "metrology/compare/surface_errors.hpp"

namespace vam::metrology {

/// Expanded uncertainty (k = 2) of each figure of figures_json(), under the same keys, by Monte Carlo [JCGM08]. 20
/// trials disturb the distances by drawn errors, remove the effect of the alignment, and measure a quarter of the
/// points. The uncertainty is twice the standard deviation and mean departure combined; the mean departure of an
/// extreme counts 1 / (sqrt(2) - 1) times, as it has the noise of the print already.
[[nodiscard]] Json expanded_uncertainty(const Inspection& inspection, const model::TriangleSoup& print,
                                        const SurfaceErrors& errors);

/// RMS of the vertices, cell, and the common parts, for a report.
[[nodiscard]] Json to_json(const SurfaceErrors& errors);

}  // namespace vam::metrology
