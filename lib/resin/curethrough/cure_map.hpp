// SPDX-License-Identifier: GPL-3.0-or-later
// Outcome of a print: correctly cured, cure-through, undercured, and how wrong the height of each feature is
// [CURE19 fig 2, 4 and 5c].
#pragma once

#include <cstdint>
#include <vector>

#include "resin/curethrough/column_dose.hpp"

namespace vam::resin {

enum class Cure : std::uint8_t { empty = 0, correct = 1, through = 2, under = 3 };

/// A voxel, by the dose at its centre (in units of D_f) and whether it is in the part.
[[nodiscard]] Cure cure_of(double centre_dose, bool solid);

/// Heights in slices. The error of a feature is the height undercured inside it, plus the height cured through in the
/// gap on its platform side (it is this feature's light that cures there), plus, of a column's last feature, what is
/// cured beyond its bottom edge.
struct FeatureErrors {
  std::int64_t features = 0;
  double under = 0;  // sums over the features
  double through = 0;
  double worst = 0;  // largest error of one feature
  [[nodiscard]] double mean() const { return features > 0 ? (under + through) / static_cast<double>(features) : 0; }
  void add(const FeatureErrors& other);
};

struct CureTotals {
  std::int64_t correct = 0;  // voxels
  std::int64_t through = 0;
  std::int64_t under = 0;
  std::vector<FeatureErrors> by_height;  // [h]: features h slices high; [0] unused
  [[nodiscard]] FeatureErrors all() const;
};

/// Takes a print slice by slice in printing order.
class CureMap {
 public:
  CureMap(int width, int height, int slices, const CureLimits& limits);

  /// Row y of the next slice. phi: Phi / full; below: Omega at the node below the slice (StackDose::replay_row); solid:
  /// values >= 0.5 are in the part. Rows may be added by many threads at once.
  void add_row(int y, const float* phi, double full, const float* below, const float* solid);
  /// After the last slice.
  [[nodiscard]] CureTotals finish();

 private:
  struct Pixel {
    int height = 0;   // slices of the feature so far; 0 outside
    int pending = 0;  // height of the last complete feature, kept until the next begins
    float under = 0;  // of the feature in progress or pending
    float above = 0;  // cured in the gap before it
    float gap = 0;    // cured in the gap in progress
  };
  void step(Pixel& pixel, bool solid, double cured, CureTotals& totals) const;
  static void settle(Pixel& pixel, float extra, CureTotals& totals);
  int width_;
  CureLimits limits_;
  std::vector<Pixel> pixels_;
  std::vector<CureTotals> rows_;
};

/// One column: phi per slice, at least as many as the part has.
[[nodiscard]] CureTotals judge_column(const std::vector<std::uint8_t>& part, const std::vector<double>& phi,
                                      const CureLimits& limits);

}  // namespace vam::resin
