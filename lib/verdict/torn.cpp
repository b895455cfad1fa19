// SPDX-License-Identifier: GPL-3.0-or-later
#include "verdict/private/torn.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <utility>

#include "base/index.hpp"
#include "verdict/private/bit_slice.hpp"

namespace vam::verdict {

namespace {

constexpr std::uint8_t in_print = printed::part | printed::cured;

constexpr int around = 27;  // a voxel and its neighbours, in three rows of three slices

/// Of each of them those that it touches, as bits.
constexpr std::array<std::uint32_t, around> neighbours = [] {
  const auto apart = [](int i, int j) { return i > j ? i - j : j - i; };
  std::array<std::uint32_t, around> all{};
  for (int i = 0; i < around; ++i) {
    for (int j = 0; j < around; ++j) {
      const bool near = apart(i % 3, j % 3) <= 1 && apart(i / 3 % 3, j / 3 % 3) <= 1 && apart(i / 9, j / 9) <= 1;
      if (near) all[i] |= std::uint32_t{1} << j;
    }
  }
  return all;
}();

/// In how many pieces these bits are.
int pieces_of(std::uint32_t bits) {
  int pieces = 0;
  for (; bits != 0; ++pieces) {
    for (std::uint32_t open = bits & -bits; open != 0;) {
      const std::uint32_t near = neighbours[std::countr_zero(open)] & bits;
      bits &= ~near;
      open = (open & (open - 1)) | (near & ~(open & -open));
    }
  }
  return pieces;
}

/// Of three slices, what is lost and left.
class Voxels {
 public:
  Voxels(Torn what, int width, int height, const std::uint8_t* const* slices) {
    const bool gap = what == Torn::gap;
    const auto is_lost = [gap](std::uint8_t voxel) {
      return gap ? (voxel & (printed::edge | printed::cured)) == printed::cured : (voxel & in_print) == printed::part;
    };
    const auto is_left = [gap](std::uint8_t voxel) { return (voxel & in_print) == (gap ? 0 : in_print); };
    for (int k = 0; k < 3; ++k) {
      const std::uint8_t* slice = slices[k];
      if (slice == nullptr) {
        lost_.emplace_back(width, height);
        left_.emplace_back(width, height, gap);
      } else {
        lost_.emplace_back(width, height, false, [&](std::size_t at) { return is_lost(slice[at]); });
        left_.emplace_back(width, height, gap, [&](std::size_t at) { return is_left(slice[at]); });
      }
    }
  }

  [[nodiscard]] const BitSlice& lost() const { return lost_[1]; }
  /// Of what is left, among the voxel and its 26 neighbours.
  [[nodiscard]] int pieces_around(int x, int y) const {
    std::uint32_t left = 0;
    for (int row = around / 3 - 1; row >= 0; --row) left = left << 3U | left_[row / 3].some(x - 1, y + row % 3 - 1, 3);
    return pieces_of(left);
  }
  /// Left, with a lost one among its 26 neighbours.
  [[nodiscard]] BitSlice rim() const {
    BitSlice rim(lost().width(), lost().height());
    if (std::none_of(lost_.begin(), lost_.end(), [](const BitSlice& slice) { return slice.any(); })) return rim;
    for (int y = 0; y < rim.height(); ++y) {
      const auto lost_at = [&](int n) {
        BitSlice::Word any = 0;
        for (const BitSlice& slice : lost_) any |= slice.row(y - 1)[n] | slice.row(y)[n] | slice.row(y + 1)[n];
        return any;
      };
      constexpr int last = BitSlice::word_bits - 1;
      for (int n = 0; n < rim.words(); ++n) {
        const BitSlice::Word here = lost_at(n);
        const BitSlice::Word before = n > 0 ? lost_at(n - 1) >> last : 0;
        const BitSlice::Word after = n + 1 < rim.words() ? lost_at(n + 1) << last : 0;
        rim.row(y)[n] = left_[1].row(y)[n] & (here | here << 1U | here >> 1U | before | after);
      }
    }
    return rim;
  }

 private:
  std::vector<BitSlice> lost_, left_;
};

/// Of the lost run with this number.
void add_torn(TornSlice& slice, std::size_t lost_run, const Voxels& voxels) {
  const VoxelRun run = slice.lost[lost_run];
  bool goes_on = false;
  std::int64_t torn = 0;
  for (int x = run.begin; x < run.end; ++x) {
    const int pieces = voxels.pieces_around(x, run.row);
    if (pieces != 1 && !goes_on) {
      slice.torn.push_back({run.row, x, x});
      slice.lost_run.push_back(lost_run);
      slice.apart.push_back(0);
    }
    goes_on = pieces != 1;
    if (!goes_on) continue;
    ++torn;
    ++slice.torn.back().end;
    slice.apart.back() += pieces > 1 ? 1 : 0;
  }
  slice.torn_of_lost.push_back(torn);
}

}  // namespace

TornSlice torn_slice(Torn what, int width, int height, const std::uint8_t* const* slices) {
  const Voxels voxels(what, width, height, slices);
  TornSlice found;
  found.lost = voxels.lost().runs();
  for (std::size_t run = 0; run < found.lost.size(); ++run) add_torn(found, run, voxels);
  found.rim = voxels.rim().runs();
  return found;
}

std::vector<std::size_t> torn_voxels(Torn what, int width, int height, const std::uint8_t* const* slices) {
  std::vector<std::size_t> torn;
  for (const VoxelRun& run : torn_slice(what, width, height, slices).torn) {
    for (int x = run.begin; x < run.end; ++x) torn.push_back(product(run.row, width) + static_cast<std::size_t>(x));
  }
  return torn;
}

namespace {

/// Sums over sets, at the runs that stand for them.
std::vector<std::int64_t> of_sets(const RunSets& sets, const std::vector<std::int64_t>& of_runs) {
  std::vector<std::int64_t> sums(sets.runs(), 0);
  for (std::size_t run = 0; run < sets.runs(); ++run) sums[sets.set_of(run)] += of_runs[run];
  return sums;
}

/// The same of the runs that are left, now that others are forgotten.
std::vector<std::int64_t> carried(const std::vector<std::int64_t>& of_sets, const std::vector<std::size_t>& now,
                                  std::size_t runs) {
  std::vector<std::int64_t> sums(runs, 0);
  for (std::size_t set = 0; set < of_sets.size(); ++set) {
    if (of_sets[set] > 0 && now[set] != RunSets::gone) sums[now[set]] = of_sets[set];
  }
  return sums;
}

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
  lost_.add(slice.lost, Touching::corners);
  rim_.add(slice.rim, Touching::corners);
  torn_.add(slice.torn, Touching::corners);
  apart_.insert(apart_.end(), slice.apart.begin(), slice.apart.end());
  torn_of_lost_.insert(torn_of_lost_.end(), slice.torn_of_lost.begin(), slice.torn_of_lost.end());
  counted_.resize(lost_.runs());
  const std::size_t lost = lost_.first_of_last();
  for (const std::size_t run : slice.lost_run) lost_of_torn_.push_back(lost + run);
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

/// Those that do not reach the last slice.
void TornSets::decide_torn() {
  constexpr std::int64_t least_apart = 3;
  const std::vector<std::int64_t> apart = of_sets(torn_, apart_);
  const std::vector<std::size_t> lost = lost_of_torn_;
  const std::vector<std::size_t> now = torn_.forget([&](std::size_t set) {
    if (apart[set] < least_apart && torn_.voxels(set) < least_torn_) return;
    count(torn_.voxels(set), torn_.place(set));
    counted_[lost[set]] += torn_.voxels(set);
  });
  apart_ = carried(apart, now, torn_.runs());
  lost_of_torn_.assign(torn_.runs(), 0);
  for (std::size_t run = 0; run < now.size(); ++run) {
    if (now[run] != RunSets::gone) lost_of_torn_[now[run]] = lost[run];
  }
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
  decide_torn();
  const std::vector<std::int64_t> torn = of_sets(lost_, torn_of_lost_);
  const std::vector<std::int64_t> counted = of_sets(lost_, counted_);
  const std::vector<std::size_t> runs = lost_.forget([&](std::size_t set) {
    std::vector<Piece> pieces;
    for (auto at = std::lower_bound(touching_.begin(), touching_.end(), std::pair{set, Piece{0}});
         at != touching_.end() && at->first == set; ++at) {
      pieces.push_back(at->second);
    }
    judge(torn[set] == lost_.voxels(set), {lost_.voxels(set) - counted[set], lost_.place(set), std::move(pieces)});
  });
  std::erase_if(touching_, [&](const auto& pair) { return runs[pair.first] == RunSets::gone; });
  thin_out(touching_, ended);
  for (auto& [lost, piece] : touching_) lost = runs[lost];
  torn_of_lost_ = carried(torn, runs, lost_.runs());
  counted_ = carried(counted, runs, lost_.runs());
  for (std::size_t& lost : lost_of_torn_) lost = runs[lost];
}

void TornSets::count(std::int64_t voxels, const VoxelPlace& at) {
  found_.voxels += voxels;
  if (voxels <= found_.largest) return;
  found_.largest = voxels;
  found_.at = at;
}

/// A set that is complete, its pieces in order. is_whole: all of it is torn.
void TornSets::judge(bool is_whole, Undecided set) {
  const bool cut = set.pieces.size() > 1 && set.pieces.back() >= ended;  // which no other will ever be one with
  if (cut || (set.pieces.empty() && is_whole)) {
    count(set.voxels, set.at);
  } else if (set.pieces.size() > 1) {
    undecided_.push_back(std::move(set));
  }
}

void TornSets::judge_undecided(const std::vector<Piece>& now) {
  for (Undecided& set : std::exchange(undecided_, {})) {
    for (Piece& piece : set.pieces) piece = now[piece];
    std::sort(set.pieces.begin(), set.pieces.end());
    set.pieces.erase(std::unique(set.pieces.begin(), set.pieces.end()), set.pieces.end());
    judge(false, std::move(set));
  }
}

// Above the last slice is nothing, so that all ends there.
Defects TornSets::found() const {
  TornSets all = *this;
  all.add({});
  return all.found_;
}

}  // namespace vam::verdict
