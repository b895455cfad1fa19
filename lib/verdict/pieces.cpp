// SPDX-License-Identifier: GPL-3.0-or-later
#include "verdict/private/pieces.hpp"

#include <algorithm>
#include <utility>

#include "base/index.hpp"
#include "verdict/private/bit_slice.hpp"

namespace vam::verdict {

void for_near_runs(const std::vector<VoxelRun>& runs, const std::vector<VoxelRun>& others, int rows_apart,
                   const std::function<void(std::size_t i, std::size_t j)>& pair) {
  std::size_t first = 0;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const VoxelRun& run = runs[i];
    const int row = run.row + rows_apart;
    const auto is_before = [&](const VoxelRun& other) {
      return other.row < row || (other.row == row && other.end < run.begin);
    };
    while (first < others.size() && is_before(others[first])) ++first;
    for (std::size_t j = first; j < others.size() && others[j].row == row && others[j].begin <= run.end; ++j)
      pair(i, j);
  }
}

std::size_t RunSets::set_of(std::size_t run) const {
  while (parent_[run] != run) {
    parent_[run] = parent_[parent_[run]];
    run = parent_[run];
  }
  return run;
}

void RunSets::join(std::size_t a, std::size_t b) {
  a = set_of(a);
  b = set_of(b);
  if (a == b) return;
  if (voxels_[a] < voxels_[b]) std::swap(a, b);
  parent_[b] = a;
  voxels_[a] += voxels_[b];
}

void RunSets::join_faces(const Lists& lists, int rows_apart) {
  for_near_runs(lists.of, lists.others, rows_apart, [&](std::size_t i, std::size_t j) {
    if (lists.of[i].begin >= lists.others[j].end || lists.others[j].begin >= lists.of[i].end) return;
    join(lists.first + i, lists.second + j);
  });
}

void RunSets::join_edges(const Lists& lists, int rows_apart, const Joins& joins) {
  for_near_runs(lists.of, lists.others, rows_apart, [&](std::size_t i, std::size_t j) {
    if (set_of(lists.first + i) == set_of(lists.second + j)) return;
    const VoxelRun& one = lists.of[i];
    const VoxelRun& other = lists.others[j];
    for (int dx = -1; dx <= 1; ++dx) {
      const int end = std::min(one.end, other.end - dx);
      for (int x = std::max(one.begin, other.begin - dx); x < end; ++x) {
        if (joins({x, one.row, dx, rows_apart, lists.below})) return join(lists.first + i, lists.second + j);
      }
    }
  });
}

void RunSets::add(const std::vector<VoxelRun>& slice, const Joins& joins) {
  const std::size_t first = parent_.size();
  for (const VoxelRun& run : slice) {
    parent_.push_back(parent_.size());
    voxels_.push_back(run.end - run.begin);
    places_.push_back({(run.begin + run.end) / 2, run.row, slices_});
  }
  ++slices_;
  const Lists level{slice, slice, first, first, false};
  const Lists below{slice, last_, first, first - last_.size(), true};
  join_faces(level, -1);
  join_faces(below, 0);
  join_edges(level, -1, joins);
  for (const int rows_apart : {-1, 0, 1}) join_edges(below, rows_apart, joins);
  last_ = slice;
}

std::vector<std::size_t> RunSets::forget(const std::function<void(std::size_t set)>& complete) {
  const std::size_t first = first_of_last();
  std::vector<std::size_t> stands(runs(), gone);  // for a set, of the last slice
  std::vector<std::size_t> parents;
  std::vector<std::int64_t> voxels;
  std::vector<VoxelPlace> places;
  for (std::size_t run = first; run < runs(); ++run) {
    const std::size_t set = set_of(run);
    if (stands[set] == gone) stands[set] = run - first;
    parents.push_back(stands[set]);
    voxels.push_back(voxels_[set]);
    places.push_back(places_[set]);
  }
  std::vector<std::size_t> now;
  for (std::size_t run = 0; run < runs(); ++run) {
    now.push_back(stands[set_of(run)]);
    if (parent_[run] == run && now.back() == gone) complete(run);
  }
  parent_ = std::move(parents);
  voxels_ = std::move(voxels);
  places_ = std::move(places);
  return now;
}

void PieceCounter::add(const std::vector<VoxelRun>& slice, const Joins& joins) {
  open_.add(slice, joins);
  open_.forget([this](std::size_t set) { complete_ += open_.voxels(set) >= least_ ? 1 : 0; });
}

int PieceCounter::count() const {
  int pieces = complete_;
  for (std::size_t run = 0; run < open_.runs(); ++run) {
    if (open_.set_of(run) == run && open_.voxels(run) >= least_) ++pieces;
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
  counter_.add(reaching(width_, height_, slice.data(), level_).runs(),
               [&](const VoxelPair& pair) { return joins(pair, slice); });
  last_ = std::move(slice);
}

}  // namespace vam::verdict
