// SPDX-License-Identifier: GPL-3.0-or-later
#include "verdict/private/break_finder.hpp"

#include <algorithm>
#include <array>
#include <bit>

#include "base/index.hpp"
#include "verdict/private/bit_slice.hpp"

namespace vam::verdict {

namespace {

constexpr std::uint8_t in_print = printed::part | printed::cured;

constexpr int around = 27;  // a voxel and its neighbours, in three rows of three slices

/// For each of them: those that it touches, as bits.
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

/// Missing and kept voxels of three slices.
class Voxels {
 public:
  Voxels(Defect what, int width, int height, const std::uint8_t* const* slices) {
    const bool gap = what == Defect::shut;
    const auto is_missing = [gap](std::uint8_t voxel) {
      return gap ? (voxel & (printed::edge | printed::cured)) == printed::cured : (voxel & in_print) == printed::part;
    };
    const auto is_kept = [gap](std::uint8_t voxel) { return (voxel & in_print) == (gap ? 0 : in_print); };
    for (int k = 0; k < 3; ++k) {
      const std::uint8_t* slice = slices[k];
      if (slice == nullptr) {
        missing_.emplace_back(width, height);
        kept_.emplace_back(width, height, gap);
      } else {
        missing_.emplace_back(width, height, false, [&](std::size_t at) { return is_missing(slice[at]); });
        kept_.emplace_back(width, height, gap, [&](std::size_t at) { return is_kept(slice[at]); });
      }
    }
  }

  [[nodiscard]] const BitSlice& missing() const { return missing_[1]; }
  /// Of the kept ones among the voxel and its 26 neighbours.
  [[nodiscard]] int pieces_around(int x, int y) const {
    std::uint32_t kept = 0;
    for (int row = around / 3 - 1; row >= 0; --row) kept = kept << 3U | kept_[row / 3].some(x - 1, y + row % 3 - 1, 3);
    return pieces_of(kept);
  }
  /// Kept, with a missing one among its 26 neighbours.
  [[nodiscard]] BitSlice boundary() const {
    BitSlice boundary(missing().width(), missing().height());
    if (std::none_of(missing_.begin(), missing_.end(), [](const BitSlice& slice) { return slice.any(); }))
      return boundary;
    for (int y = 0; y < boundary.height(); ++y) {
      const auto missing_at = [&](int n) {
        BitSlice::Word any = 0;
        for (const BitSlice& slice : missing_) any |= slice.row(y - 1)[n] | slice.row(y)[n] | slice.row(y + 1)[n];
        return any;
      };
      constexpr int last = BitSlice::word_bits - 1;
      for (int n = 0; n < boundary.words(); ++n) {
        const BitSlice::Word here = missing_at(n);
        const BitSlice::Word before = n > 0 ? missing_at(n - 1) >> last : 0;
        const BitSlice::Word after = n + 1 < boundary.words() ? missing_at(n + 1) << last : 0;
        boundary.row(y)[n] = kept_[1].row(y)[n] & (here | here << 1U | here >> 1U | before | after);
      }
    }
    return boundary;
  }

 private:
  std::vector<BitSlice> missing_, kept_;
};

/// Adds the torn voxels of the missing run with this number.
void add_torn(DefectSlice& slice, std::size_t missing_run, const Voxels& voxels) {
  const VoxelRun run = slice.missing[missing_run];
  bool goes_on = false;
  std::int64_t torn = 0;
  for (int x = run.begin; x < run.end; ++x) {
    const int pieces = voxels.pieces_around(x, run.row);
    if (pieces != 1 && !goes_on) {
      slice.torn.push_back({run.row, x, x});
      slice.missing_run.push_back(missing_run);
      slice.apart.push_back(0);
    }
    goes_on = pieces != 1;
    if (!goes_on) continue;
    ++torn;
    ++slice.torn.back().end;
    slice.apart.back() += pieces > 1 ? 1 : 0;
  }
  slice.torn_of_missing.push_back(torn);
}

}  // namespace

DefectSlice defect_slice(Defect what, int width, int height, const std::uint8_t* const* slices) {
  const Voxels voxels(what, width, height, slices);
  DefectSlice found;
  found.missing = voxels.missing().runs();
  for (std::size_t run = 0; run < found.missing.size(); ++run) add_torn(found, run, voxels);
  found.boundary = voxels.boundary().runs();
  return found;
}

std::vector<std::size_t> defect_voxels(Defect what, int width, int height, const std::uint8_t* const* slices) {
  std::vector<std::size_t> torn;
  for (const VoxelRun& run : defect_slice(what, width, height, slices).torn) {
    for (int x = run.begin; x < run.end; ++x) torn.push_back(product(run.row, width) + static_cast<std::size_t>(x));
  }
  return torn;
}

namespace {

/// Pairs are in order. Of the pieces of a set that have ended, the first and the last suffice to tell that it is cut.
void drop_redundant_pairs(std::vector<std::pair<std::size_t, std::size_t>>& touching, std::size_t ended) {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < touching.size(); ++i) {
    const auto [missing, piece] = touching[i];
    const bool first = kept == 0 || touching[kept - 1].first != missing;
    const bool last = i + 1 == touching.size() || touching[i + 1].first != missing;
    if (piece < ended || first || last) touching[kept++] = touching[i];
  }
  touching.resize(kept);
}

}  // namespace

void BreakFinder::note_touching(const std::vector<VoxelRun>& missing, std::size_t first_missing,
                                const std::vector<VoxelRun>& boundary, std::size_t first_boundary) {
  for (const int rows_apart : {-1, 0, 1}) {
    for_near_runs(missing, boundary, rows_apart,
                  [&](std::size_t i, std::size_t j) { touching_.emplace_back(first_missing + i, first_boundary + j); });
  }
}

void BreakFinder::add(const DefectSlice& slice) {
  const std::vector<VoxelRun> missing_below = missing_.last();
  const std::vector<VoxelRun> boundary_below = boundary_.last();
  missing_.add(slice.missing, Touching::corners);
  boundary_.add(slice.boundary, Touching::corners);
  torn_.add(slice.torn, Touching::corners);
  const std::size_t missing = missing_.first_of_last();
  for (std::size_t n = 0; n < slice.missing.size(); ++n) missing_[missing + n].torn += slice.torn_of_missing[n];
  for (std::size_t n = 0; n < slice.torn.size(); ++n) {
    RunSet& set = torn_[torn_.first_of_last() + n];
    set.apart += slice.apart[n];
    set.missing_run = missing + slice.missing_run[n];
  }
  const std::size_t boundary = boundary_.first_of_last();
  note_touching(slice.missing, missing, slice.boundary, boundary);
  note_touching(slice.missing, missing, boundary_below, boundary - boundary_below.size());
  note_touching(missing_below, missing - missing_below.size(), slice.boundary, boundary);
  decide();
}

/// The piece of each run of the boundary, once only the last slice is known.
std::vector<BreakFinder::Piece> BreakFinder::forget_boundary() {
  std::vector<std::size_t> sets;
  for (std::size_t run = 0; run < boundary_.runs(); ++run) sets.push_back(boundary_.set_of(run));
  std::vector<Piece> ends(sets.size());  // of each set that ends
  std::vector<Piece> now = boundary_.forget([&](std::size_t set) { ends[set] = ended | ended_pieces_++; });
  for (std::size_t run = 0; run < now.size(); ++run) {
    if (now[run] == RunSets::gone) now[run] = ends[sets[run]];
  }
  return now;
}

/// Those that do not reach the last slice.
void BreakFinder::decide_torn() {
  constexpr std::int64_t least_apart = 3;
  torn_.forget([&](std::size_t run) {
    const RunSet& set = torn_[run];
    if (set.apart < least_apart && set.voxels < least_torn_) return;
    count(set.voxels, set.at);
    missing_[set.missing_run].counted += set.voxels;
  });
}

/// Keeps what is still open: missing sets that reach the last slice, and those whose pieces may yet become one.
void BreakFinder::decide() {
  const std::vector<Piece> now = forget_boundary();
  judge_undecided(now);
  for (auto& [missing, piece] : touching_) {
    missing = missing_.set_of(missing);
    if (piece < ended) piece = now[piece];
  }
  std::sort(touching_.begin(), touching_.end());
  touching_.erase(std::unique(touching_.begin(), touching_.end()), touching_.end());
  decide_torn();
  const std::vector<std::size_t> runs = missing_.forget([&](std::size_t run) {
    std::vector<Piece> pieces;
    for (auto at = std::lower_bound(touching_.begin(), touching_.end(), std::pair{run, Piece{0}});
         at != touching_.end() && at->first == run; ++at) {
      pieces.push_back(at->second);
    }
    const RunSet& set = missing_[run];
    judge(set.torn == set.voxels, {set.voxels - set.counted, set.at, std::move(pieces)});
  });
  std::erase_if(touching_, [&](const auto& pair) { return runs[pair.first] == RunSets::gone; });
  drop_redundant_pairs(touching_, ended);
  for (auto& [missing, piece] : touching_) missing = runs[missing];
  for (std::size_t run = 0; run < torn_.runs(); ++run) {
    if (torn_.set_of(run) == run) torn_[run].missing_run = runs[torn_[run].missing_run];
  }
}

void BreakFinder::count(std::int64_t voxels, const VoxelPlace& at) {
  found_.voxels += voxels;
  if (voxels <= found_.largest) return;
  found_.largest = voxels;
  found_.at = at;
}

/// A set that is complete, its pieces in order. is_whole: all of it is torn.
void BreakFinder::judge(bool is_whole, Undecided set) {
  const bool cut = set.pieces.size() > 1 && set.pieces.back() >= ended;  // which no other will ever be one with
  if (cut || (set.pieces.empty() && is_whole)) {
    count(set.voxels, set.at);
  } else if (set.pieces.size() > 1) {
    undecided_.push_back(std::move(set));
  }
}

void BreakFinder::judge_undecided(const std::vector<Piece>& now) {
  for (Undecided& set : std::exchange(undecided_, {})) {
    for (Piece& piece : set.pieces) piece = now[piece];
    std::sort(set.pieces.begin(), set.pieces.end());
    set.pieces.erase(std::unique(set.pieces.begin(), set.pieces.end()), set.pieces.end());
    judge(false, std::move(set));
  }
}

// Above the last slice is nothing, so that all ends there.
Defects BreakFinder::found() const {
  BreakFinder all = *this;
  all.add({});
  return all.found_;
}

}  // namespace vam::verdict
