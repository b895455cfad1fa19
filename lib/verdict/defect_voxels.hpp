// SPDX-License-Identifier: GPL-3.0-or-later
// The voxels of a slice at which a wall is cut or missing, or a gap is bridged.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "model/dose/dose_metrics.hpp"

namespace vam::verdict {

/// Of a voxel, as bits.
namespace printed {
inline constexpr std::uint8_t part = 1;   // at least half covered
inline constexpr std::uint8_t cured = 2;  // receives the threshold
inline constexpr std::uint8_t edge = 4;   // at least a quarter covered
inline constexpr std::uint8_t trace = 8;  // at least 1/32 covered, as by a thin rod
}  // namespace printed
[[nodiscard]] constexpr std::uint8_t printed_bits(float coverage, bool cured) {
  return static_cast<std::uint8_t>((coverage >= static_cast<float>(model::half_surface) ? printed::part : 0) |
                                   (coverage >= 0.25F ? printed::edge : 0) |
                                   (coverage >= 1 / 32.0F ? printed::trace : 0) | (cured ? printed::cured : 0));
}

/// broken: voxels of the part are missing if they do not cure, else kept. shut: void that is less than a quarter
/// covered is missing if it cures; void that stays liquid is kept.
enum class Defect { broken, shut };

/// The torn voxels of a slice, by their numbers: missing ones whose 26 neighbours have none that is kept, as in a hole
/// of a wall, or whose kept neighbours are not connected, as at the foot of a wall that hangs on by its ends.
[[nodiscard]] std::vector<std::size_t> defect_voxels(Defect what, int width, int height,
                                                     const std::uint8_t* const* slices);

/// Which voxels of the middle one of three slices of coverage are of lost walls, by their numbers; nullptr beyond the
/// volume.
[[nodiscard]] std::vector<std::size_t> lost_walls(int width, int height, const float* const* slices);

}  // namespace vam::verdict
