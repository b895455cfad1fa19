// SPDX-License-Identifier: GPL-3.0-or-later
// The part and the print as bodies that can be turned.
#pragma once

#include <optional>
#include <string>

#include "io/vdb/vdb.hpp"

namespace vam::report_tool {

/// A dose and the threshold at which it prints, in its unit.
struct PrintedDose {
  const io::SparseVolume* dose = nullptr;
  double threshold = 0;
};

/// HTML: the design's surface, with a dose coloured by the margin of the dose there, and the print's, coloured by its
/// signed distance from the design. An insert is seen with both. Surfaces are made on voxels averaged until they have
/// less than 60,000 vertices; both lie in the part's frame, heights without the stretch of the printer.
[[nodiscard]] std::string body_view(const io::SparseVolume& target, const std::optional<PrintedDose>& print,
                                    const io::SparseVolume* insert);

}  // namespace vam::report_tool
