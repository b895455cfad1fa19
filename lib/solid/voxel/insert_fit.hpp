// SPDX-License-Identifier: GPL-3.0-or-later
// A part and the insert it is printed around: what is taken out of the part, and how the two meet.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "base/index.hpp"
#include "base/text/json_fwd.hpp"
#include "model/grid.hpp"
#include "solid/voxel/part.hpp"

namespace vam::solid {

/// The insert grown by a clearance, slice by slice. Growing takes for the coverage of a voxel the largest of
/// c(u) + clearance - |v - u| over the voxels u of the insert's surface, in voxels: exact for faces along the grid, to
/// a tenth of a voxel for others, and up to 0.4 voxels too near at sharp edges and corners; 0 leaves the insert as it
/// is.
class GrownInsert {
 public:
  /// `read` gives slice k of the insert's coverage; it is called in ascending order. stretch_z: of both, so that the
  /// clearance is that of the print.
  GrownInsert(const model::Grid& grid, const std::function<void(int k, float* out)>& read, double clearance_mm,
              double stretch_z);
  /// Raises the coverage in slice k, the insert's own, to the grown one's.
  void grow(int k, float* slice) const;

 private:
  struct Rim {
    int i;
    int j;
    float coverage;
  };
  model::Grid grid_;
  double clearance_px_;
  double stretch_z_;
  std::vector<std::vector<Rim>> rims_;  // by slice: voxels of the surface
};

/// How they meet, gathered slice by slice in ascending order.
class InsertFit {
 public:
  /// They touch across a clearance, too.
  InsertFit(const model::Grid& grid, double clearance_mm)
      : grid_(grid), reach_(1 + ceil_int(clearance_mm / grid.voxel_mm)) {}
  void add(const float* part, const float* insert);
  /// The insert touches the part: a voxel of it is in, beside or above one of the part.
  [[nodiscard]] bool meets() const { return contact_ > 0; }
  [[nodiscard]] double shared_mm3(double stretch_z) const;
  /// They share room: more than a thousandth of the insert, to which the coverage of curved shapes is exact.
  [[nodiscard]] bool overlap() const { return shared_ > 1e-3 * insert_; }
  /// Of the lines along x, y and z that lead from the insert to the part within reach: the share on which no voxel is
  /// more than three quarters free, so that the room between them is printed shut.
  [[nodiscard]] double shut_share() const {
    return lines_ > 0 ? static_cast<double>(shut_) / static_cast<double>(lines_) : 0;
  }
  /// insert: volume_mm3, slices, slices_of_part, contact_voxels, shared_mm3.
  [[nodiscard]] Json figures(double stretch_z) const;

 private:
  /// What was met last on a line of voxels, and since.
  struct Line {
    enum class Met : std::uint8_t { nothing, part, insert };
    Met met = Met::nothing;
    std::uint8_t steps = 0;
    bool free = false;
  };
  void follow(Line& line, float part, float insert);
  void follow_lines(const float* part, const float* insert);
  [[nodiscard]] double mm3(double voxels, double stretch_z) const;

  [[nodiscard]] bool touches(const float* part, int i, int j) const;

  model::Grid grid_;
  int reach_;                     // voxels between those that touch
  std::vector<float> last_part_;  // the slice below
  std::vector<Line> upwards_;     // one a column
  std::int64_t lines_ = 0;
  std::int64_t shut_ = 0;
  double insert_ = 0;  // volumes in voxels
  double shared_ = 0;
  std::int64_t contact_ = 0;
  int slices_ = 0;
  int common_slices_ = 0;
};

/// The part without what the insert, grown by the clearance, takes up; read as GrownInsert reads.
[[nodiscard]] Part without_insert(const Part& part, std::function<void(int k, float* out)> read, double clearance_mm,
                                  double stretch_z);

}  // namespace vam::solid
