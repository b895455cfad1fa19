// SPDX-License-Identifier: GPL-3.0-or-later
// Separate pieces of a part and of its print: a wall that is cut off, or two walls that are joined, have no wrong voxel
// where only voxels that the surface cuts lie between.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "model/grid.hpp"
#include "model/part_surface.hpp"
#include "model/pieces.hpp"
#include "model/smooth_print.hpp"
#include "model/torn.hpp"
#include "model/tunnels.hpp"

namespace vam::model {

struct PrintPieces {
  static constexpr std::int64_t least_voxels = 8;  // of a piece: smaller ones are rounded tips and edges
  int part = 0;          // of voxels with a trace of it that share a corner: thin rods hold together
  int part_at_half = 0;  // of the coverage at a half: narrow gaps part it
  int print = 0;         // of the dose at the threshold
  int print_fewer = 0;   // and by how many it is in fewer or more with 1 and 2 % less and more dose [other_dose]
  int print_more = 0;
  TornSets::Found broken = {};  // of the part
  TornSets::Found shut = {};    // of gaps
  std::int64_t holes = 0;  // tunnels of the print, smooth ones [SmoothPrint], beyond those of the part; not less than 0
  std::int64_t firm_holes = 0;  // of these, on which 2 % of the dose do not decide [firm_dose]
  int solids = 0;               // of the part's own surface; 0: not known
  int specks = 0;               // of these, so small that they may not count
  /// Where most hang together of what is broken and shut, in mm of the print; not known before set_places().
  std::optional<std::array<double, 3>> broken_at_mm = std::nullopt, shut_at_mm = std::nullopt;

  /// Both were counted on these voxels.
  void set_places(const Grid& grid, double stretch_z) {
    const auto place = [&](const TornSets::Found& found) -> std::optional<std::array<double, 3>> {
      if (found.voxels == 0) return std::nullopt;
      return std::array{grid.x_mm(found.at.column), grid.y_mm(found.at.row), grid.z_mm(found.at.slice) / stretch_z};
    };
    broken_at_mm = place(broken);
    shut_at_mm = place(shut);
  }
  void set_solids(const PartSurface& surface) {
    solids = surface.solids;
    specks = surface.specks;
  }
  [[nodiscard]] bool loses_walls() const { return broken.voxels > 0; }
  [[nodiscard]] bool shuts_gaps() const { return shut.voxels > 0; }
  [[nodiscard]] bool has_holes() const { return firm_holes > 0; }
  [[nodiscard]] bool may_have_holes() const { return holes > 0; }
  /// In how many pieces the part is, as far as its surface or the two numbers tell.
  [[nodiscard]] int fewest() const { return solids > 0 ? solids - specks : std::min(part, part_at_half); }
  [[nodiscard]] int most() const { return solids > 0 ? solids : std::max(part, part_at_half); }
  [[nodiscard]] bool knows_pieces() const { return solids > 0 || part == part_at_half; }
  [[nodiscard]] bool is_in_other_pieces() const { return print < fewest() || print > most(); }
  [[nodiscard]] int print_least() const { return print - print_fewer; }
  [[nodiscard]] int print_most() const { return print + print_more; }
  [[nodiscard]] bool may_be_in_other_pieces() const { return print_least() < fewest() || print_most() > most(); }
  [[nodiscard]] bool is_certain() const { return knows_pieces() && !may_have_holes() && !may_be_in_other_pieces(); }
  [[nodiscard]] bool is_as_part() const {
    return !is_in_other_pieces() && !loses_walls() && !shuts_gaps() && !has_holes();
  }
  [[nodiscard]] bool is_surely_as_part() const { return is_as_part() && is_certain(); }
};

/// Slice by slice, from the lowest up.
class PrintPieceCounter {
 public:
  /// threshold: more than 0.
  PrintPieceCounter(int width, int height, double threshold);
  /// The next slices, row-major: coverage 0...1, and dose, 0 where it is not judged.
  void add(int count, const float* coverage, const float* dose);
  /// Of the slices so far, beyond which is nothing.
  [[nodiscard]] PrintPieces found() const;

 private:
  using Slice = std::vector<std::uint8_t>;  // of bits
  int width_, height_;
  double threshold_;
  PieceCounter part_;
  FieldPieces part_at_half_, print_;
  std::vector<FieldPieces> print_of_others_;  // of other doses
  TunnelCounter of_part_, of_print_, of_smooth_, of_firm_;
  SmoothPrint smooth_;
  std::vector<Slice> last_;                        // up to two
  TornSets broken_{Torn::part}, shut_{Torn::gap};  // in all but the last slice
};

}  // namespace vam::model
