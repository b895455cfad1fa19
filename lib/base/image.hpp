// SPDX-License-Identifier: GPL-3.0-or-later
// A dense image of floats and views of flat memory: the only array types that cross module borders.
#pragma once

#include <cstddef>
#include <vector>

namespace vam {

/// Row-major image: pixel (x, y) is values[y * width + x]; x runs along the detector, y along angles or rows.
struct Image {
  int width = 0;
  int height = 0;
  std::vector<float> values;

  Image() = default;
  Image(int columns, int rows, float fill = 0.0F)
      : width(columns), height(rows), values(static_cast<std::size_t>(columns) * rows, fill) {}

  [[nodiscard]] std::size_t size() const { return values.size(); }
  [[nodiscard]] std::size_t index(int x, int y) const { return static_cast<std::size_t>(y) * width + x; }
  float& operator()(int x, int y) { return values[index(x, y)]; }
  float operator()(int x, int y) const { return values[index(x, y)]; }
  float* row(int y) { return values.data() + index(0, y); }
  [[nodiscard]] const float* row(int y) const { return values.data() + index(0, y); }
};

}  // namespace vam
