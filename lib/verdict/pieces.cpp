// SPDX-License-Identifier: GPL-3.0-or-later
#include "verdict/private/pieces.hpp"

#include <algorithm>
#include <utility>

#include "base/index.hpp"

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
  if (sets_[a].voxels < sets_[b].voxels) std::swap(a, b);
  parent_[b] = a;
  sets_[a].take(sets_[b]);
}

void RunSets::join_near(const Lists& lists, int rows_apart, Touching touching) {
  for_near_runs(lists.of, lists.others, rows_apart, [&](std::size_t i, std::size_t j) {
    const bool overlap = lists.of[i].begin < lists.others[j].end && lists.others[j].begin < lists.of[i].end;
    if (overlap || touching == Touching::corners) join(lists.first + i, lists.second + j);
  });
}

void RunSets::add(const std::vector<VoxelRun>& slice, Touching touching) {
  const std::size_t first = parent_.size();
  for (const VoxelRun& run : slice) {
    parent_.push_back(parent_.size());
    sets_.push_back({.voxels = run.end - run.begin, .at = {(run.begin + run.end) / 2, run.row, slices_}});
  }
  ++slices_;
  const Lists level{slice, slice, first, first};
  const Lists below{slice, last_, first, first - last_.size()};
  join_near(level, -1, Touching::faces);
  join_near(below, 0, Touching::faces);
  if (touching == Touching::corners) {
    join_near(level, -1, touching);
    for (const int rows_apart : {-1, 0, 1}) join_near(below, rows_apart, touching);
  }
  last_ = slice;
}

std::vector<std::size_t> RunSets::forget(const std::function<void(std::size_t set)>& complete) {
  const std::size_t first = first_of_last();
  std::vector<std::size_t> stands(runs(), gone);  // for a set, of the last slice
  std::vector<std::size_t> parents;
  std::vector<RunSet> sets;
  for (std::size_t run = first; run < runs(); ++run) {
    const std::size_t set = set_of(run);
    if (stands[set] == gone) stands[set] = run - first;
    parents.push_back(stands[set]);
    sets.push_back(sets_[set]);
  }
  std::vector<std::size_t> now;
  for (std::size_t run = 0; run < runs(); ++run) {
    now.push_back(stands[set_of(run)]);
    if (parent_[run] == run && now.back() == gone) complete(run);
  }
  parent_ = std::move(parents);
  sets_ = std::move(sets);
  return now;
}

void PieceCounter::add(const std::vector<VoxelRun>& slice, Touching touching, const JoinMore& join_more) {
  const std::vector<VoxelRun> before = open_.last();
  open_.add(slice, touching);
  if (join_more) join_more(open_, before);
  open_.forget([this](std::size_t set) {
    ++complete_;
    large_ += open_[set].voxels >= least_ ? 1 : 0;
  });
}

std::int64_t PieceCounter::counted(std::int64_t least) const {
  std::int64_t pieces = least == 0 ? complete_ : large_;
  for (std::size_t run = 0; run < open_.runs(); ++run)
    pieces += open_.set_of(run) == run && open_[run].voxels >= least ? 1 : 0;
  return pieces;
}

}  // namespace vam::verdict
