// SPDX-License-Identifier: GPL-3.0-or-later
// Test parts as slices of coverage, drawn by sampling: nothing is shared with lib/solid.
#pragma once

#include <functional>
#include <vector>

namespace vam::oracle {

/// size x size coverage 0...1, row-major, of the region inside(x, y), x and y in pixels from the centre; 8 x 8 samples
/// a pixel. Nothing is left outside a circle of radius 0.48 size.
std::vector<float> draw(int size, const std::function<bool(double, double)>& inside);

/// Discs of radius 8 px on a square grid of 35 px [RAY21 fig 7]; scale stretches both.
std::vector<float> disc_grid(int size, double scale);

/// A gyroid's slice at height z: |sin x cos y + sin y cos z + sin z cos x| < level, `cells` cells across.
std::vector<float> gyroid(int size, double cells, double z, double level);

/// A thick ring with spokes and a hub.
std::vector<float> wheel(int size);

/// Bars and gaps of 3...40 px (for size 512, smaller in proportion, never below 2), rings and strokes; binary.
std::vector<float> resolution_target(int size);

}  // namespace vam::oracle
