// SPDX-License-Identifier: GPL-3.0-or-later
// Dose of a slit of light that shines evenly from 0 to T, whose parts diffuse from when they arrive to the end of the
// print: the mean over arrival times t of what Gaussians of variance 2 D (T - t) leave. Shares nothing with lib/light.
#pragma once

namespace vam::oracle {

struct SlitPrint {
  double slit_mm;
  double diffusion_mm2_s;
  double seconds;
};

/// At x_mm from the slit's middle when the light goes off, of a dose that is 1 in the slit and 0 beside it without
/// diffusion.
double diffused_dose(const SlitPrint& print, double x_mm);

}  // namespace vam::oracle
