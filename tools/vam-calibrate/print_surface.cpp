// SPDX-License-Identifier: GPL-3.0-or-later
#include "metrology/cure/bodies.hpp"
#include "session/surface.hpp"
#include "vam-calibrate/scan.hpp"

namespace vam::calibrate_tool {

model::TriangleSoup print_surface(const std::string& path, std::optional<double> isovalue) {
  return session::read_surface(path, isovalue,
                               [&](model::Volume& volume) { (void)metrology::keep_bodies(volume, *isovalue, {}); });
}

}  // namespace vam::calibrate_tool
