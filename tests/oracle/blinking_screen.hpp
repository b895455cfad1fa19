// SPDX-License-Identifier: GPL-3.0-or-later
// A screen that shows black and white by an order, and a camera that sees it: physics of both, stepped in time.
#pragma once

#include <cstdint>
#include <random>
#include <utility>
#include <vector>

namespace vam::oracle {

/// A screen that changes its image at vertical blanks only, and a light that follows it late and gradually.
struct ScreenTruth {
  double hz = 60;
  double delay_s = 0.03;   // from a vertical blank until the light begins to follow
  double rise_s = 0.0005;  // its time constant: it approaches what is shown exponentially, up and down
  double missed = 0.01;    // share of vertical blanks at which a busy machine comes too late
  double hold_s = 0.02;    // of each step of the order
  std::vector<int> order;  // 0: black, else white; begins anew after the last
};

struct CameraTruth {
  double hz = 10;
  double exposure_s = 0.02;
  double jitter_s = 0.0001;  // of the time stamps, one standard deviation
  double noise = 0.005;      // of a frame's mean, over that of white
  double lost = 0.01;        // share of frames that do not arrive
  double ground = 0.1;       // light of the room, over that of white
  int frames = 150;
};

struct BlinksSeen {
  std::vector<std::pair<double, bool>> flips;  // time, and whether to white, of every vertical blank; not the missed
  std::vector<double> stamp_s;                 // middle of each exposure as the camera tells it
  std::vector<double> light;                   // mean of each frame
};

[[nodiscard]] BlinksSeen watch_blinks(const ScreenTruth& screen, const CameraTruth& camera, std::mt19937_64& random);

}  // namespace vam::oracle
