// SPDX-License-Identifier: GPL-3.0-or-later
// Writes doses slice by slice into the volume.
#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "io/vdb/vdb.hpp"
#include "model/circle.hpp"
#include "model/dose/dose_metrics.hpp"
#include "model/dose/stray_cure.hpp"
#include "score/exposure.hpp"
#include "vam-dose/insert.hpp"
#include "vam-dose/place.hpp"

namespace vam::dose_tool {

/// Takes them in ascending order, writes them eight at a time, and gathers their statistics.
class Sink {
 public:
  /// judged: where part and void are distinguished, if at all.
  Sink(io::SparseVolume& volume, const Place& place, const Insert& insert, int first,
       std::optional<model::Circle> judged);

  /// The insert's voxels become dark.
  void add(Image& dose);
  void flush();
  [[nodiscard]] const score::TurnDoses& range() const { return range_; }
  [[nodiscard]] model::DoseMetrics judged() const { return statistics_.metrics(false); }
  [[nodiscard]] model::StrayDoses outside() { return std::move(outside_); }

 private:
  void judge(const Image& dose, const Image& part);

  io::SparseVolume& volume_;
  const io::SparseVolume* target_;
  const Insert& insert_;
  int next_;
  int pending_ = 0;
  std::vector<float> buffer_;
  score::TurnDoses range_;
  std::optional<model::Circle> judged_;
  model::DoseStatistics statistics_;
  model::VoxelBox part_;
  model::StrayDoses outside_;  // void outside the part's box
};

/// Multiplies the whole volume.
void scale(io::SparseVolume& volume, double factor);

}  // namespace vam::dose_tool
