// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/torn.hpp"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <utility>

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
  [[nodiscard]] bool is_whole() const {
    Neighbourhood rest = *this;
    int pieces = 0;
    for (int i = 0; i < size; ++i) {
      if (!rest.left_[i]) continue;
      ++pieces;
      rest.clear(i);
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
    return !around.is_whole();
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

namespace {

/// Of the pieces of a set that have ended the first and the last tell that it is cut; in order.
void thin_out(std::vector<std::pair<std::size_t, std::size_t>>& touching, std::size_t ended) {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < touching.size(); ++i) {
    const auto [lost, piece] = touching[i];
    const bool first = kept == 0 || touching[kept - 1].first != lost;
    const bool last = i + 1 == touching.size() || touching[i + 1].first != lost;
    if (piece < ended || first || last) touching[kept++] = touching[i];
  }
  touching.resize(kept);
}

}  // namespace

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
  decide();
}

/// What each run of the rim is a piece of once only the last slice is known.
std::vector<TornSets::Piece> TornSets::forget_rim() {
  std::vector<std::size_t> sets;
  for (std::size_t run = 0; run < rim_.runs(); ++run) sets.push_back(rim_.set_of(run));
  std::vector<Piece> ends(sets.size());  // of each set that ends
  std::vector<Piece> now = rim_.forget([&](std::size_t set) { ends[set] = ended | ended_pieces_++; });
  for (std::size_t run = 0; run < now.size(); ++run) {
    if (now[run] == RunSets::gone) now[run] = ends[sets[run]];
  }
  return now;
}

/// Keeps what is still open: lost sets that reach the last slice, and those whose pieces may yet become one.
void TornSets::decide() {
  const std::vector<Piece> now = forget_rim();
  judge_undecided(now);
  for (auto& [lost, piece] : touching_) {
    lost = lost_.set_of(lost);
    if (piece < ended) piece = now[piece];
  }
  std::sort(touching_.begin(), touching_.end());
  touching_.erase(std::unique(touching_.begin(), touching_.end()), touching_.end());
  std::vector<std::int64_t> torn(lost_.runs(), 0);
  for (std::size_t run = 0; run < lost_.runs(); ++run) torn[lost_.set_of(run)] += torn_[run];

  const std::vector<std::size_t> runs = lost_.forget([&](std::size_t set) {
    std::vector<Piece> pieces;
    for (auto at = std::lower_bound(touching_.begin(), touching_.end(), std::pair{set, Piece{0}});
         at != touching_.end() && at->first == set; ++at) {
      pieces.push_back(at->second);
    }
    judge(lost_.voxels(set), torn[set], std::move(pieces));
  });
  std::erase_if(touching_, [&](const auto& pair) { return runs[pair.first] == RunSets::gone; });
  thin_out(touching_, ended);
  for (auto& [lost, piece] : touching_) lost = runs[lost];
  torn_.assign(lost_.runs(), 0);
  for (std::size_t set = 0; set < torn.size(); ++set) {
    if (torn[set] > 0 && runs[set] != RunSets::gone) torn_[runs[set]] = torn[set];
  }
}

/// Of a set that is complete, with the pieces that touch it, in order.
void TornSets::judge(std::int64_t voxels, std::int64_t torn, std::vector<Piece> pieces) {
  constexpr std::int64_t least_torn = 3;
  const bool whole = pieces.empty() && torn == voxels;
  const bool cut = pieces.size() > 1 && pieces.back() >= ended;  // which no other will ever be one with
  if (whole || cut || torn >= least_torn) {
    voxels_ += voxels;
  } else if (pieces.size() > 1) {
    undecided_.push_back({voxels, std::move(pieces)});
  }
}

void TornSets::judge_undecided(const std::vector<Piece>& now) {
  for (auto& [voxels, pieces] : std::exchange(undecided_, {})) {
    for (Piece& piece : pieces) piece = now[piece];
    std::sort(pieces.begin(), pieces.end());
    pieces.erase(std::unique(pieces.begin(), pieces.end()), pieces.end());
    judge(voxels, 0, std::move(pieces));
  }
}

// Above the last slice is nothing, so that all ends there.
std::int64_t TornSets::voxels() const {
  TornSets all = *this;
  all.add({});
  return all.voxels_;
}

}  // namespace vam::model
