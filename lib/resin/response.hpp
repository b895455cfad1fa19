// SPDX-License-Identifier: GPL-3.0-or-later
// The projector's response: grey level to intensity and back.
#pragma once

#include <cstddef>
#include <vector>

#include "base/image.hpp"
#include "base/index.hpp"
#include "base/pixels.hpp"
#include "model/printer.hpp"
#include "model/response_table.hpp"

namespace vam::resin {

/// A monotone curve from grey to intensity, both as fractions of full grey in [0, 1]: a monotone cubic through the
/// measured points [FC80; physics §14.3], so it never overshoots between them.
class Response {
 public:
  /// A straight line from dark_fraction (what leaks at grey 0) to 1.
  explicit Response(double dark_fraction = 0.0);

  /// The curve through a measured table. Throws Fault::data when it does not begin at grey 0, grey does not rise,
  /// intensity falls anywhere, or there is no light.
  explicit Response(const model::ResponseTable& table);

  /// Intensity in [intensity(0), 1] at a grey in [0, 1]; greys outside are clamped.
  [[nodiscard]] double intensity(double grey) const;

  /// The inverse: the lowest grey that gives this intensity; 0 below intensity(0), the lowest full grey above 1.
  [[nodiscard]] double grey(double intensity) const;

 private:
  std::vector<double> grey_;
  std::vector<double> intensity_;
  std::vector<double> slope_;  // d intensity / d grey at each point
};

/// Straight from min/max_intensity_mw_cm2, for a projector without a measured table.
[[nodiscard]] Response projector_response(const model::Projector& projector);

/// The 2^bits grey levels of a projector and the intensity of each.
class GreyLevels {
 public:
  /// bits in 1..16; throws Fault::usage otherwise.
  GreyLevels(const Response& response, int bits);

  [[nodiscard]] int bits() const { return bits_; }
  [[nodiscard]] int count() const { return count_of(intensity_); }

  /// The level whose intensity is nearest to the wanted one (fraction of full, clamped to what the projector can do):
  /// nearest in intensity, since that is what the resin counts. Of two equally near ones the lower.
  [[nodiscard]] int level(float intensity) const;

  /// What a level gives, as a fraction of full intensity.
  [[nodiscard]] float intensity(int level) const { return intensity_[level]; }

 private:
  [[nodiscard]] int nearest(float intensity) const;

  int bits_;
  std::vector<float> intensity_;  // rising with the level
  std::vector<float> least_;      // wanted intensity from which on a higher level than this one is the nearest
  std::vector<int> first_;        // of each of equal steps of intensity: the nearest level to its begin
  std::size_t reach_ = 1;         // power of 2: twice that many levels, less one, may follow within a step
};

/// Intensity of an image, summed, and the pixels that were clipped.
struct LightTally {
  double light = 0;  // sum over the pixels, fractions of full
  long pixels = 0;
  long lit = 0;      // pixels above 0
  long clipped = 0;  // pixels that should have been brighter than full
  LightTally& operator+=(const LightTally& other);
};

/// Multiplies by scale and clips at full intensity, 1.
LightTally limit_to_full(Image& image, float scale);

/// Whether all of a row is 0. Most rows of most frames are: one look at their bits is many times as fast as work on
/// them.
[[nodiscard]] bool is_dark(const Image& image, int y);

/// Every pixel's nearest level, in the memory of an earlier image. Intensities are fractions of full; beyond what the
/// projector can do they are clamped.
void to_levels(const Image& intensity, const GreyLevels& levels, GreyImage& image);
/// Those of a part of the image; the rest stays as it is.
void put_levels(const Image& part, int left, int top, const GreyLevels& levels, GreyImage& image);

/// What the projector gives for these levels, as fractions of full intensity.
[[nodiscard]] Image to_intensity(const GreyImage& image, const GreyLevels& levels);
/// The same in place for greys 0...1.
void to_intensity(Image& greys, const Response& response);

}  // namespace vam::resin
