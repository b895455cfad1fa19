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

/// pair(i, j) of all runs that have columns in common or next to each other. Both lists are in order: the runs of a row
/// are compared with those `rows_apart` rows below it.
template <class Pair>
void PieceCounter::for_near_runs(const Lists& lists, int rows_apart, const Pair& pair) const {
  std::size_t j = 0;
  for (std::size_t i = 0; i < lists.of.size(); ++i) {
    const VoxelRun& run = lists.of[i];
    const std::vector<VoxelRun>& others = lists.others;
    const int row = run.row + rows_apart;
    while (j < others.size() && (others[j].row < row || (others[j].row == row && others[j].end < run.begin))) ++j;
    for (std::size_t k = j; k < others.size() && others[k].row == row && others[k].begin <= run.end; ++k) pair(i, k);
  }
}

void PieceCounter::join_faces(const Lists& lists, int rows_apart) {
  for_near_runs(lists, rows_apart, [&](std::size_t i, std::size_t k) {
    if (lists.of[i].begin >= lists.others[k].end || lists.others[k].begin >= lists.of[i].end) return;
    join(lists.first + i, lists.second + k);
  });
}

void PieceCounter::join_edges(const Lists& lists, int rows_apart, const Joins& joins) {
  for_near_runs(lists, rows_apart, [&](std::size_t i, std::size_t k) {
    if (root(lists.first + i) == root(lists.second + k)) return;
    const VoxelRun& one = lists.of[i];
    const VoxelRun& other = lists.others[k];
    for (int dx = -1; dx <= 1; ++dx) {
      const int end = std::min(one.end, other.end - dx);
      for (int x = std::max(one.begin, other.begin - dx); x < end; ++x) {
        if (joins({x, one.row, dx, rows_apart, lists.below})) return join(lists.first + i, lists.second + k);
      }
    }
  });
}

void PieceCounter::add(const std::vector<VoxelRun>& slice, const Joins& joins) {
  const std::size_t first = parent_.size();
  for (const VoxelRun& run : slice) {
    parent_.push_back(parent_.size());
    voxels_.push_back(run.end - run.begin);
  }
  const Lists level{slice, slice, first, first, false};
  const Lists below{slice, last_, first, first - last_.size(), true};
  join_faces(level, -1);
  join_faces(below, 0);
  join_edges(level, -1, joins);
  for (const int rows_apart : {-1, 0, 1}) join_edges(below, rows_apart, joins);
  last_ = slice;
}

int PieceCounter::count(std::int64_t least_voxels) const {
  int pieces = 0;
  for (std::size_t run = 0; run < parent_.size(); ++run) {
    if (parent_[run] == run && voxels_[run] >= least_voxels) ++pieces;
  }
  return pieces;
}

bool FieldPieces::joins(const VoxelPair& pair, const std::vector<float>& slice) const {
  const auto value = [&](int x, int y, bool below) {
    return static_cast<double>((below ? last_ : slice)[product(y, width_) + static_cast<std::size_t>(x)]);
  };
  const int x = pair.x + pair.dx;
  const int y = pair.y + pair.dy;
  if (pair.dx != 0 && pair.dy != 0 && pair.below) {  // the middle of the eight
    double sum = 0;
    for (const bool below : {false, true}) {
      sum += value(pair.x, pair.y, below) + value(x, pair.y, below) + value(pair.x, y, below) + value(x, y, below);
    }
    return sum / 8 >= level_;
  }
  // Of the four, the saddle of their bilinear interpolation, as above the level: it lies on the best way.
  const double a = value(pair.x, pair.y, false) - level_;
  const double d = value(x, y, pair.below) - level_;
  const bool flat = !pair.below;  // else the other two are those beside them in the same row or column
  const double b = (flat ? value(x, pair.y, false) : value(x, y, false)) - level_;
  const double c = (flat ? value(pair.x, y, false) : value(pair.x, pair.y, true)) - level_;
  return b >= 0 || c >= 0 || a * d >= b * c;
}

void FieldPieces::add(std::vector<float> slice) {
  const auto runs = runs_of(width_, height_, [&](std::size_t i) { return static_cast<double>(slice[i]) >= level_; });
  counter_.add(runs, [&](const VoxelPair& pair) { return joins(pair, slice); });
  last_ = std::move(slice);
}

namespace {

bool has(std::uint8_t voxel, std::uint8_t bits) { return (voxel & bits) == bits; }

/// What is left around a voxel of the part that cures, or of the void that does not, in three rows of three slices.
class Neighbourhood {
 public:
  void set(int dx, int dy, int dz) { left_[index(dx, dy, dz)] = true; }
  /// Whether there are none, or they are in more than one piece without the voxel in the middle.
  [[nodiscard]] bool is_torn() {
    int pieces = 0;
    for (int i = 0; i < size; ++i) {
      if (!left_[i]) continue;
      ++pieces;
      clear(i);
    }
    return pieces != 1;
  }

 private:
  static constexpr int size = 27;
  static int index(int dx, int dy, int dz) { return (dz + 1) * 9 + (dy + 1) * 3 + dx + 1; }
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

}  // namespace

std::vector<std::size_t> torn_voxels(Torn what, int width, int height, const std::uint8_t* const* slices) {
  constexpr std::uint8_t print = printed::part | printed::cured;
  const bool gap = what == Torn::gap;
  const auto is_lost = [gap](std::uint8_t voxel) {
    return gap ? (voxel & (printed::edge | printed::cured)) == printed::cured : (voxel & print) == printed::part;
  };
  const auto is_left = [gap](std::uint8_t voxel) { return gap ? (voxel & print) == 0 : has(voxel, print); };
  std::vector<std::size_t> voxels;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const std::size_t at = product(y, width) + static_cast<std::size_t>(x);
      if (!is_lost(slices[1][at])) continue;
      Neighbourhood around;
      for (int n = 0; n < 27; ++n) {
        const int dx = n % 3 - 1;
        const int dy = n / 3 % 3 - 1;
        const int dz = n / 9 - 1;
        const int u = x + dx;
        const int v = y + dy;
        const bool in = slices[dz + 1] != nullptr && u >= 0 && u < width && v >= 0 && v < height;
        const std::uint8_t voxel = in ? slices[dz + 1][product(v, width) + static_cast<std::size_t>(u)] : 0;
        if (is_left(voxel)) around.set(dx, dy, dz);
      }
      if (around.is_torn()) voxels.push_back(at);
    }
  }
  return voxels;
}

PrintPieceCounter::PrintPieceCounter(int width, int height, double threshold)
    : width_(width),
      height_(height),
      threshold_(threshold),
      part_at_half_(width, height, half_surface),
      print_(width, height, threshold) {}

/// Nullptr beyond the volume.
PrintPieceCounter::TornVoxels PrintPieceCounter::torn(const Slice* below, const Slice& slice,
                                                      const Slice* above) const {
  const auto bits = [](const Slice* of) { return of == nullptr ? nullptr : of->data(); };
  const std::array<const std::uint8_t*, 3> slices{bits(below), slice.data(), bits(above)};
  const auto count = [&](Torn what) { return std::ssize(torn_voxels(what, width_, height_, slices.data())); };
  return {count(Torn::part), count(Torn::gap)};
}

void PrintPieceCounter::add(int count, const float* coverage, const float* dose) {
  const std::size_t size = product(width_, height_);
  std::vector<Slice> slices(count, Slice(size));
  parallel_for(count, [&](int k) {
    const std::size_t first = product(k, size);
    for (std::size_t i = 0; i < size; ++i) {
      slices[k][i] = printed_bits(coverage[first + i], static_cast<double>(dose[first + i]) >= threshold_);
    }
  });
  std::vector<const Slice*> all;
  for (const Slice& slice : last_) all.push_back(&slice);
  for (const Slice& slice : slices) all.push_back(&slice);
  // Of the last two, one has been counted already, and the last of all waits for the one above it.
  const int first = last_.empty() ? 0 : count_of(last_) - 1;
  std::vector<TornVoxels> torn(std::max(count_of(all) - 1 - first, 0));
  parallel_for(count_of(torn), [&](int n) {
    const int k = first + n;
    torn[n] = this->torn(k > 0 ? all[k - 1] : nullptr, *all[k], all[k + 1]);
  });
  for (const TornVoxels& voxels : torn) {
    torn_.broken += voxels.broken;
    torn_.shut += voxels.shut;
  }
  constexpr int counters = 3;
  parallel_for(counters, [&](int counter) {
    for (int k = 0; k < count; ++k) {
      const auto slice = [&](const float* of) {
        return std::vector<float>(of + product(k, size), of + product(k + 1, size));
      };
      if (counter == 0) {
        const auto runs = runs_of(width_, height_, [&](std::size_t i) { return has(slices[k][i], printed::trace); });
        part_.add(runs, [](const VoxelPair&) { return true; });
      } else if (counter == 1) {
        part_at_half_.add(slice(coverage));
      } else {
        print_.add(slice(dose));
      }
    }
  });
  std::vector<Slice> last;
  for (std::size_t k = all.size() - std::min<std::size_t>(all.size(), 2); k < all.size(); ++k) last.push_back(*all[k]);
  last_ = std::move(last);
}

PrintPieces PrintPieceCounter::found() const {
  constexpr std::int64_t least = PrintPieces::least_voxels;
  TornVoxels all = torn_;
  if (!last_.empty()) {
    const TornVoxels top = torn(last_.size() > 1 ? &last_.front() : nullptr, last_.back(), nullptr);
    all.broken += top.broken;
    all.shut += top.shut;
  }
  return {part_.count(least), part_at_half_.count(least), print_.count(least), all.broken, all.shut};
}

}  // namespace vam::model
