// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/exr/private/intensities.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#include "base/text/text.hpp"
#include "io/stream/finite.hpp"

namespace vam::io::exr {

namespace {

// Intensities of projections are relative to what cures the resin; a value beyond has another unit, or is damaged, and
// would leave all others dark.
constexpr float most_intensity = 1e9F;

// On the bits, which order positive numbers as their values do, without an early exit: vector code. most: above 0.
bool all_within(const Image& image, float most) {
  bool above = false;
  for (const float value : image.values)
    above |= std::bit_cast<std::int32_t>(value) > std::bit_cast<std::int32_t>(most);
  return !above && all_finite(image.values.data(), image.size());
}

}  // namespace

std::string objection(const Image& image, std::size_t index, model::Space space) {
  constexpr float largest = std::numeric_limits<float>::max();
  const float most = space == model::Space::camera ? largest : most_intensity;
  if (all_within(image, most)) return "";
  const auto is_good = [most](float value) { return value >= -largest && value <= most; };  // NaN is not
  const auto bad = std::find_if_not(image.values.begin(), image.values.end(), is_good);
  const auto at = bad - image.values.begin();
  const std::string pixel = "pixel " + std::to_string(at % image.width) + ", " + std::to_string(at / image.width) +
                            " of image " + std::to_string(index) + " is ";
  if (!std::isfinite(*bad)) return pixel + "not a finite number";
  return pixel + format_number(*bad, 3) + ", but intensities are at most 1e9; check the unit";
}

}  // namespace vam::io::exr
