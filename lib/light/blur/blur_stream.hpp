// SPDX-License-Identifier: GPL-3.0-or-later
// Gaussian blur of a volume by the beam's point spread and the diffusion of dose, slice by slice [physics §4].
#pragma once

#include <deque>
#include <functional>
#include <memory>

#include "base/image.hpp"

namespace vam::light {

class GaussianBlur;

/// Gaussian blur of a volume with the same sigma along x, y and z, in a stream: slices in, slices out in order, as soon
/// as those above them are known. Outside the volume is 0. Holds as many slices as the kernel is high.
class BlurStream {
 public:
  BlurStream(double sigma_px, std::function<void(Image)> out);
  ~BlurStream();
  void push(Image slice);
  /// After the last slice.
  void finish();

 private:
  void emit(int centre);
  std::unique_ptr<GaussianBlur> smear_;
  std::function<void(Image)> out_;
  std::deque<Image> held_;  // blurred across, slices first_ ... pushed_ - 1
  int first_ = 0;
  int pushed_ = 0;
  int emitted_ = 0;
};

}  // namespace vam::light
