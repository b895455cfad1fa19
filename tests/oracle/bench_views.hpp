// SPDX-License-Identifier: GPL-3.0-or-later
// What a camera beside the bench sees of a turning print: every pixel's ray goes by vector Snell through window, bath,
// glass and resin, and the light that bodies scatter into it is summed in closed form. And what a real bench adds:
// absorption, run-out, bubbles that rise, noise, an even background, dirt on the window. Shares nothing with lib.
#pragma once

#include <array>
#include <vector>

namespace vam::oracle {

using Place = std::array<double, 3>;

/// A body of even scattering density about `centre`: a ball of radius half[0], an upright cylinder of radius half[0]
/// and half height half[2], or a block. Density -1 in a body of 1 is a hole.
struct Body {
  enum class Kind { ball, cylinder, block };
  Kind kind = Kind::ball;
  Place centre{};
  Place half{};
  double density = 1;
};

/// A ball of scattering light that rises, and goes round with the resin by a share of its angle.
struct Bubble {
  Body body;           // where it is at the first view
  double rise_mm = 0;  // per turn
  double carried = 0;  // 0: stays where it is seen, 1: turns with the vial
};

/// Light along +y; the lens looks along +y at the stage axis. Index 1 is air; window_mm 0: none.
struct ViewBench {
  double lens_mm = 200;  // 0: telecentric
  double window_mm = 0;
  double bath_index = 1;
  double vial_mm = 12.7;
  double wall_mm = 0;  // 0: no glass
  double glass_index = 1.52;
  double resin_index = 1.5;
  int columns = 480;
  int rows = 300;
  double pixel_mm = 0.05;
  double axis_column = 239.5;
  double axis_row = 149.5;  // level with the lens
  int rays = 1;             // across and along a pixel
  double azimuth_deg = 90;
  double absorption_per_mm = 0;        // of the scattered light on its way through the resin
  std::array<double, 2> run_out_mm{};  // the vial's axis from the stage's, in the frame of the vial
};

/// Row-major views, rows downwards, at stage angles 360 i / count.
std::vector<std::vector<float>> bench_views(const ViewBench& bench, const std::vector<Body>& bodies,
                                            const std::vector<Bubble>& bubbles, int count);

/// Shares of the brightest pixel, added to every view but for flicker.
struct CleaningReport {
  double noise = 0;       // deviation
  double background = 0;  // everywhere
  double flicker = 0;     // deviation of each view's light, of the view itself
  int specks = 0;         // bright or dark spots of 1 to 3 pixels that stay where they are
  unsigned draw = 3;      // of specks and noise
};
void soil(const ViewBench& bench, const CleaningReport& dirt, std::vector<std::vector<float>>& views);

/// So many bubbles of 0.15 to 0.4 mm that rise by 3 to 10 mm a turn, as bright as a print of 2 to 10 mm.
std::vector<Bubble> bubbles(int count, double reach_mm, unsigned seed);

/// Distance to the surface of what bodies of density 1 make, less those of -1; positive outside. Exact but near edges
/// where a hole cuts a face.
double distance_mm(const std::vector<Body>& bodies, const Place& point);

}  // namespace vam::oracle
