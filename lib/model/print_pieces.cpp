// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/print_pieces.hpp"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <utility>

#include "base/index.hpp"
#include "base/parallel.hpp"

namespace vam::model {

std::size_t PieceCounter::root(std::size_t run) const {
  while (parent_[run] != run) {
    parent_[run] = parent_[parent_[run]];
    run = parent_[run];
  }
  return run;
}

void PieceCounter::join(std::size_t a, std::size_t b) {
  a = root(a);
  b = root(b);
  if (a == b) return;
  if (voxels_[a] < voxels_[b]) std::swap(a, b);
  parent_[b] = a;
  voxels_[a] += voxels_[b];
}

/// Both lists are in order: the runs of a row are compared with those `rows_apart` rows below it.
void PieceCounter::join_neighbours(const std::vector<VoxelRun>& slice, std::size_t first,
                                   const std::vector<VoxelRun>& before, std::size_t first_before, int rows_apart) {
  std::size_t j = 0;
  for (std::size_t i = 0; i < slice.size(); ++i) {
    const VoxelRun& run = slice[i];
    const int row = run.row + rows_apart;
    while (j < before.size() && (before[j].row < row || (before[j].row == row && before[j].end < run.begin))) ++j;
    for (std::size_t k = j; k < before.size() && before[k].row == row && before[k].begin <= run.end; ++k) {
      join(first + i, first_before + k);
    }
  }
}

void PieceCounter::add(const std::vector<VoxelRun>& slice) {
  const std::size_t first = parent_.size();
  const std::size_t first_before = first - last_.size();
  for (const VoxelRun& run : slice) {
    parent_.push_back(parent_.size());
    voxels_.push_back(run.end - run.begin);
  }
  join_neighbours(slice, first, slice, first, -1);
  for (const int rows_apart : {-1, 0, 1}) join_neighbours(slice, first, last_, first_before, rows_apart);
  last_ = slice;
}

int PieceCounter::count(std::int64_t least_voxels) const {
  int pieces = 0;
  for (std::size_t run = 0; run < parent_.size(); ++run) {
    if (parent_[run] == run && voxels_[run] >= least_voxels) ++pieces;
  }
  return pieces;
}

namespace {

bool has(std::uint8_t voxel, std::uint8_t bits) { return (voxel & bits) == bits; }

/// The cured voxels of the part around a voxel, in three rows of three slices.
class Neighbourhood {
 public:
  void set(int dx, int dy, int dz) { cured_[index(dx, dy, dz)] = true; }
  /// Whether there are none, or they are in more than one piece without the voxel in the middle.
  [[nodiscard]] bool is_broken() {
    int pieces = 0;
    for (int i = 0; i < size; ++i) {
      if (!cured_[i]) continue;
      ++pieces;
      clear(i);
    }
    return pieces != 1;
  }

 private:
  static constexpr int size = 27;
  static int index(int dx, int dy, int dz) { return (dz + 1) * 9 + (dy + 1) * 3 + dx + 1; }
  void clear(int i) {
    cured_[i] = false;
    for (int j = 0; j < size; ++j) {
      const bool near =
          std::abs(i % 3 - j % 3) <= 1 && std::abs(i / 3 % 3 - j / 3 % 3) <= 1 && std::abs(i / 9 - j / 9) <= 1;
      if (near && cured_[j]) clear(j);
    }
  }

  std::array<bool, size> cured_{};
};

}  // namespace

std::vector<std::size_t> broken_voxels(int width, int height, const std::uint8_t* const* slices) {
  constexpr std::uint8_t print = printed::part | printed::cured;
  std::vector<std::size_t> voxels;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const std::size_t at = product(y, width) + static_cast<std::size_t>(x);
      if ((slices[1][at] & print) != printed::part) continue;
      Neighbourhood around;
      for (int dz = -1; dz <= 1; ++dz) {
        if (slices[dz + 1] == nullptr) continue;
        for (int v = std::max(y - 1, 0); v <= std::min(y + 1, height - 1); ++v) {
          for (int u = std::max(x - 1, 0); u <= std::min(x + 1, width - 1); ++u) {
            if (has(slices[dz + 1][product(v, width) + u], print)) around.set(u - x, v - y, dz);
          }
        }
      }
      if (around.is_broken()) voxels.push_back(at);
    }
  }
  return voxels;
}

/// Nullptr beyond the volume.
std::int64_t PrintPieceCounter::broken(const Slice* below, const Slice& slice, const Slice* above) const {
  const auto bits = [](const Slice* of) { return of == nullptr ? nullptr : of->data(); };
  const std::array<const std::uint8_t*, 3> slices{bits(below), slice.data(), bits(above)};
  return std::ssize(broken_voxels(width_, height_, slices.data()));
}

void PrintPieceCounter::add(const std::vector<Slice>& slices) {
  std::vector<std::vector<VoxelRun>> parts(slices.size());
  std::vector<std::vector<VoxelRun>> prints(slices.size());
  std::vector<const Slice*> all;
  for (const Slice& slice : last_) all.push_back(&slice);
  for (const Slice& slice : slices) all.push_back(&slice);
  std::vector<std::int64_t> broken(all.size(), 0);
  parallel_for(count_of(slices), [&](int k) {
    const auto runs = [&](std::uint8_t bits) {
      return runs_of(width_, height_, [&](std::size_t i) { return has(slices[k][i], bits); });
    };
    parts[k] = runs(printed::edge);
    prints[k] = runs(printed::cured);
  });
  // Of the last two, one has been counted already, and the last of all waits for the one above it.
  const int first = last_.empty() ? 0 : count_of(last_) - 1;
  parallel_for(count_of(all) - 1 - first, [&](int n) {
    const int k = first + n;
    broken[k] = this->broken(k > 0 ? all[k - 1] : nullptr, *all[k], all[k + 1]);
  });
  for (const std::int64_t voxels : broken) broken_ += voxels;
  for (std::size_t k = 0; k < slices.size(); ++k) {
    part_.add(parts[k]);
    print_.add(prints[k]);
  }
  std::vector<Slice> last;
  for (std::size_t k = all.size() - std::min<std::size_t>(all.size(), 2); k < all.size(); ++k) last.push_back(*all[k]);
  last_ = std::move(last);
}

PrintPieces PrintPieceCounter::found() const {
  constexpr std::int64_t least = PrintPieces::least_voxels;
  PrintPieces found{.part = part_.count(least), .print = print_.count(least), .broken = broken_};
  if (!last_.empty()) found.broken += broken(last_.size() > 1 ? &last_.front() : nullptr, last_.back(), nullptr);
  return found;
}

}  // namespace vam::model
