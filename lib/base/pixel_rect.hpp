// SPDX-License-Identifier: GPL-3.0-or-later
// A rectangle of pixels.
#pragma once

namespace vam {

/// Part of an image, from its left and uppermost pixel.
struct PixelRect {
  int left = 0;
  int top = 0;
  int width = 0;
  int height = 0;
};

}  // namespace vam
