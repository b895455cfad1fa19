// SPDX-License-Identifier: GPL-3.0-or-later
// A dose against a grey target, which prescribes a dose for every voxel [physics §7].
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "base/text/json_fwd.hpp"
#include "model/circle.hpp"
#include "model/dose/dose_metrics.hpp"

namespace vam::score {

/// Constraint on the void, where a grey target is 0.
enum class VoidRule {
  met,    // 0, within the band, as of other voxels
  below,  // no more than a dose that does not print
  free,   // nothing
};

struct GreyOptions {
  model::Circle circle;  // the writable one: void outside it is not judged
  double band = 0.1;     // epsilon: how far a dose may be from the target
  VoidRule void_rule = VoidRule::met;
  double void_limit = 0.75;                        // of VoidRule::below
  double unit = 1;                                 // of the target, in that of the dose
  std::optional<double> void_band = std::nullopt;  // of VoidRule::met; none: that of other voxels
};

class GreyScore {
 public:
  GreyScore(const GreyOptions& options, int width, int height);

  /// `count` row-major slices of dose and target, and of the band of each voxel; nullptr: it is the same for all.
  /// Throws Fault::data for a dose that is not finite.
  void add(const float* dose, const float* target, int count, const float* band = nullptr);

  [[nodiscard]] static const std::vector<std::string>& names();
  [[nodiscard]] double figure(const std::string& name) const;
  /// Throws Fault::data when no voxel of the target is above 0.
  [[nodiscard]] Json figures() const;
  [[nodiscard]] bool is_met() const { return wrong_ == 0; }
  /// verdict::grey_words()
  [[nodiscard]] std::string verdict() const;
  /// Aligned lines "figure value meaning", and the verdict in words.
  [[nodiscard]] std::string table() const;

 private:
  [[nodiscard]] model::DoseMetrics metrics() const;

  GreyOptions options_;
  int width_;
  int height_;
  std::int64_t part_ = 0, void_ = 0;  // judged
  std::int64_t wrong_ = 0;
  bool one_band_ = true;
  double worst_;         // max (E - epsilon)
  double largest_ = 0;   // max E
  double squares_ = 0;   // sum of E^2
  double mismatch_ = 0;  // sum of E with the sign of x - f, over the part
};

}  // namespace vam::score
