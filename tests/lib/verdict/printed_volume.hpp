// SPDX-License-Identifier: GPL-3.0-or-later
// Small volumes of voxels and their prints.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "verdict/print_pieces.hpp"

namespace vam::test {

struct Solid {
  int nx, ny, nz;
  std::vector<char> voxels;
  [[nodiscard]] bool at(int x, int y, int z) const {
    return x >= 0 && y >= 0 && z >= 0 && x < nx && y < ny && z < nz && voxels[(z * ny + y) * nx + x] != 0;
  }
};

/// Slices of coverage and dose.
class Print {
 public:
  Print(int size, int height) : size_(size), pixels_(static_cast<std::size_t>(size) * height) {}
  /// cover(pixel) 0...1 and cures(pixel), of the next slice.
  template <class Cover, class Cures>
  void add(const Cover& cover, const Cures& cures) {
    for (int i = 0; i < static_cast<int>(pixels_); ++i) {
      coverage_.push_back(cover(i));
      dose_.push_back(cures(i) ? 1.0F : 0.5F);
    }
  }
  [[nodiscard]] verdict::PrintPieces found(int a_pass) const {
    verdict::PrintPieceCounter counter(size_, static_cast<int>(pixels_) / size_, 0.8);
    for (std::size_t at = 0; at < dose_.size(); at += a_pass * pixels_) {
      const int count = std::min(a_pass, static_cast<int>((dose_.size() - at) / pixels_));
      counter.add(dose_.data() + at, coverage_.data() + at, count);
    }
    return counter.found();
  }

 private:
  int size_;
  std::size_t pixels_;
  std::vector<float> coverage_, dose_;
};

}  // namespace vam::test
