// SPDX-License-Identifier: GPL-3.0-or-later
// The print as it grows during the exposure.
#pragma once

#include <optional>
#include <string>

#include "io/vdb/vdb.hpp"
#include "plot/view.hpp"

namespace vam::view_tool {

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

}  // namespace vam::view_tool
