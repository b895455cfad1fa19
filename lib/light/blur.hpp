// Gaussian blur of a volume by the beam's point spread and the diffusion of dose, slice by slice [physics §4].
#pragma once

#include <deque>
#include <functional>
#include <memory>
#include <vector>

#include "base/image.hpp"

namespace vam::light {

/// Weights {middle, first neighbours, ...} of the discrete Gaussian e^{-t} I_n(t), t = sigma^2 in pixels: the heat
/// kernel of the lattice [LIN90]. Its variance is sigma^2 exactly, however narrow it is, and
/// two in a row are one with the sum of the variances. From t = 500 on it is the sampled Gaussian, which is the same to
/// 1e-4 of its height. Cut where less than 1e-9 is left, then normalised.
[[nodiscard]] std::vector<double> gaussian_weights(double sigma_px);

/// Standard deviation that a point spread psf (mm) and diffusion for a time have together: sqrt(psf^2 + 2 D t).
[[nodiscard]] double spread_mm(double psf_mm, double diffusion_mm2_s, double seconds);

class GaussianBlur;

/// Gaussian blur of a volume with the same sigma along x, y and z, in a stream: slices in, slices out in order, as soon
/// as those above them are known. Outside the volume is 0. Holds as many slices as the kernel is high.
class VolumeBlur {
 public:
  VolumeBlur(double sigma_px, std::function<void(Image)> out);
  ~VolumeBlur();
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
