// SPDX-License-Identifier: GPL-3.0-or-later
// Synthetic camera views: every pixel's ray is traced through glass and resin by the vector ray tracer and the
// scattering density summed along it in small steps. Shares nothing with lib/optics or lib/metrology.
#pragma once

#include <functional>
#include <vector>

#include "oracle/ray_tracer.hpp"

namespace vam::oracle {

/// Scattering density at a point of the part's frame, mm.
using Density = std::function<double(double x, double y, double z)>;

struct CameraBench {
  Bench bench;  // the lens looks along +y of its own frame
  int columns = 0;
  int rows = 0;
  double pixel_mm = 0;     // at the axis
  double axis_column = 0;  // where the axis appears in the middle row
  double tilt_rad = 0;     // lean of the axis in the image, its lower end towards higher columns
  double azimuth_deg = 0;  // of the camera about the axis, against the projector
};

class Camera {
 public:
  Camera(const CameraBench& bench, double step_mm, double reach_mm);
  /// Row-major, rows downwards, at this stage angle: the part's frame is turned by stage angle + azimuth.
  [[nodiscard]] std::vector<float> view(const Density& density, double stage_deg) const;

 private:
  struct Sight {
    bool seen = false;
    Vec start{};
    Vec direction{};
    double weight = 0;
    int steps = 0;
  };
  CameraBench bench_;
  double step_mm_;
  std::vector<Sight> sights_;
};

}  // namespace vam::oracle
