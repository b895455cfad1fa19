// SPDX-License-Identifier: GPL-3.0-or-later
// The dose of a print without the roughness of its faces, which has handles that are no holes.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace vam::verdict {

/// A dose within dose_margin of the threshold is moved to the side of it on which the part has the voxel.
[[nodiscard]] float firm_dose(float coverage, float dose, double threshold);

/// Less or more of the dose, which may decide on what hangs together: by a factor, but where a voxel wholly in the part
/// would no longer cure, or one wholly in the void would: the process window tells of those.
[[nodiscard]] float other_dose(double factor, float coverage, float dose, double threshold);

/// As firm_dose, but in walls and gaps of up to two voxels, where this little dose decides on holes and bridges: a
/// voxel is in one if up to two in a row, on a line through it and a neighbour, are between void, or between part, as
/// none is beside an even face. Slice by slice, from the lowest up; beyond the volume is void. Memory: four slices.
class SmoothPrint {
 public:
  /// threshold: more than 0.
  SmoothPrint(int width, int height, double threshold)
      : width_(width), height_(height), row_(width + 2 * reach), threshold_(threshold) {}
  /// The next slices, row-major: coverage 0...1, and dose. Returns the doses of those whose neighbours are known.
  [[nodiscard]] std::vector<float> add(int count, const float* coverage, const float* dose);
  /// Those of the last ones, up to two, beyond which is nothing.
  [[nodiscard]] std::vector<float> rest() const;

 private:
  static constexpr int reach = 2;  // voxels and slices beyond which nothing is looked at
  struct Slice {
    std::vector<std::uint8_t> part;  // at least half covered? With a margin of `reach` that is not
    std::vector<float> dose;
  };
  [[nodiscard]] std::vector<float> smooth(int first, int last) const;
  /// Of a slice, `reach` before and after it: Slice::part.
  using Around = std::array<const std::uint8_t*, 2 * reach + 1>;
  [[nodiscard]] bool is_thin(const Around& around, std::size_t at) const;

  int width_, height_, row_;  // row_: of Slice::part
  double threshold_;
  std::vector<Slice> slices_;
  int returned_ = 0;  // of these
};

}  // namespace vam::verdict
