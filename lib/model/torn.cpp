// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/torn.hpp"

#include <algorithm>
#include <array>
#include <cstdlib>

#include "base/index.hpp"

namespace vam::model {

namespace {

constexpr std::uint8_t print = printed::part | printed::cured;

/// What is left around a voxel, in three rows of three slices.
class Neighbourhood {
 public:
  static constexpr int size = 27;
  void set(int i) { left_[i] = true; }
  /// Whether it is in one piece.
  [[nodiscard]] bool is_whole() && {
    int pieces = 0;
    for (int i = 0; i < size; ++i) {
      if (!left_[i]) continue;
      ++pieces;
      clear(i);
    }
    return pieces == 1;
  }

 private:
  void clear(int i) {
    left_[i] = false;
    for (int j = 0; j < size; ++j) {
      const bool near =
          std::abs(i % 3 - j % 3) <= 1 && std::abs(i / 3 % 3 - j / 3 % 3) <= 1 && std::abs(i / 9 - j / 9) <= 1;
      if (near && left_[j]) clear(j);
    }
  }

  std::array<bool, size> left_{};
};

/// Of three slices of bits, what is lost and left.
class Voxels {
 public:
  Voxels(Torn what, int width, int height, const std::uint8_t* const* slices)
      : gap_(what == Torn::gap), width_(width), height_(height), slices_(slices) {}

  [[nodiscard]] bool is_lost(std::uint8_t voxel) const {
    return gap_ ? (voxel & (printed::edge | printed::cured)) == printed::cured : (voxel & print) == printed::part;
  }
  [[nodiscard]] bool is_left(std::uint8_t voxel) const {
    return gap_ ? (voxel & print) == 0 : (voxel & print) == print;
  }
  [[nodiscard]] bool is_lost(std::size_t at) const { return is_lost(slices_[1][at]); }
  [[nodiscard]] bool is_torn(std::size_t at) const {
    if (!is_lost(at)) return false;
    Neighbourhood around;
    for_neighbours(at, [&](int n, std::uint8_t voxel) {
      if (is_left(voxel)) around.set(n);
      return false;
    });
    return !std::move(around).is_whole();
  }
  [[nodiscard]] bool is_rim(std::size_t at) const {
    return is_left(slices_[1][at]) && for_neighbours(at, [this](int, std::uint8_t voxel) { return is_lost(voxel); });
  }

 private:
  /// visit(n, voxel) of it and its 26 neighbours, until one returns true, which is returned.
  template <class Visit>
  bool for_neighbours(std::size_t at, const Visit& visit) const {
    const int x = static_cast<int>(at % static_cast<std::size_t>(width_));
    const int y = static_cast<int>(at / static_cast<std::size_t>(width_));
    for (int n = 0; n < 27; ++n) {
      const std::uint8_t* slice = slices_[n / 9];
      const int u = x + n % 3 - 1;
      const int v = y + n / 3 % 3 - 1;
      const bool in = slice != nullptr && u >= 0 && u < width_ && v >= 0 && v < height_;
      if (visit(n, in ? slice[product(v, width_) + static_cast<std::size_t>(u)] : std::uint8_t{0})) return true;
    }
    return false;
  }

  bool gap_;
  int width_, height_;
  const std::uint8_t* const* slices_;
};

}  // namespace

TornSlice torn_slice(Torn what, int width, int height, const std::uint8_t* const* slices) {
  const Voxels voxels(what, width, height, slices);
  TornSlice found;
  found.lost = runs_of(width, height, [&](std::size_t at) { return voxels.is_lost(at); });
  for (const VoxelRun& run : found.lost) {
    std::int64_t torn = 0;
    for (int x = run.begin; x < run.end; ++x) {
      torn += voxels.is_torn(product(run.row, width) + static_cast<std::size_t>(x)) ? 1 : 0;
    }
    found.torn.push_back(torn);
  }
  bool any = !found.lost.empty();
  for (const int k : {0, 2}) {
    const std::uint8_t* slice = slices[k];
    any = any || (slice != nullptr && std::any_of(slice, slice + product(width, height),
                                                  [&](std::uint8_t voxel) { return voxels.is_lost(voxel); }));
  }
  if (any) found.rim = runs_of(width, height, [&](std::size_t at) { return voxels.is_rim(at); });
  return found;
}

std::vector<std::size_t> torn_voxels(Torn what, int width, int height, const std::uint8_t* const* slices) {
  const Voxels voxels(what, width, height, slices);
  std::vector<std::size_t> torn;
  for (std::size_t at = 0; at < product(width, height); ++at) {
    if (voxels.is_torn(at)) torn.push_back(at);
  }
  return torn;
}

void TornSets::note_touching(const std::vector<VoxelRun>& lost, std::size_t first_lost,
                             const std::vector<VoxelRun>& rim, std::size_t first_rim) {
  for (const int rows_apart : {-1, 0, 1}) {
    for_near_runs(lost, rim, rows_apart,
                  [&](std::size_t i, std::size_t j) { touching_.emplace_back(first_lost + i, first_rim + j); });
  }
}

void TornSets::add(const TornSlice& slice) {
  const std::vector<VoxelRun> lost_below = lost_.last();
  const std::vector<VoxelRun> rim_below = rim_.last();
  lost_.add(slice.lost, at_corners);
  rim_.add(slice.rim, at_corners);
  torn_.insert(torn_.end(), slice.torn.begin(), slice.torn.end());
  const std::size_t lost = lost_.first_of_last();
  const std::size_t rim = rim_.first_of_last();
  note_touching(slice.lost, lost, slice.rim, rim);
  note_touching(slice.lost, lost, rim_below, rim - rim_below.size());
  note_touching(lost_below, lost - lost_below.size(), slice.rim, rim);
}

std::int64_t TornSets::voxels() const {
  constexpr std::int64_t least_torn = 3;
  const std::size_t none = rim_.runs();
  std::vector<std::size_t> rim(lost_.runs(), none);  // of each set, one piece around it
  std::vector<bool> cut(lost_.runs(), false);
  for (const auto& [run, beside] : touching_) {
    const std::size_t set = lost_.set_of(run);
    const std::size_t piece = rim_.set_of(beside);
    if (rim[set] == none) rim[set] = piece;
    if (rim[set] != piece) cut[set] = true;
  }
  std::vector<std::int64_t> torn(lost_.runs(), 0);
  for (std::size_t run = 0; run < lost_.runs(); ++run) torn[lost_.set_of(run)] += torn_[run];
  std::int64_t voxels = 0;
  for (std::size_t run = 0; run < lost_.runs(); ++run) {
    if (lost_.set_of(run) != run) continue;
    const bool whole = rim[run] == none && torn[run] == lost_.voxels(run);
    if (whole || cut[run] || torn[run] >= least_torn) voxels += lost_.voxels(run);
  }
  return voxels;
}

}  // namespace vam::model
