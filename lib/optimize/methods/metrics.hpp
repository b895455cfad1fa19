// SPDX-License-Identifier: GPL-3.0-or-later
// Figures of merit of doses, slice by slice.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "model/dose/dose_metrics.hpp"
#include "optimize/target/problem.hpp"

namespace vam::optimize {

/// Largest value of each slice inside the circle, at least 0.
[[nodiscard]] PerSlice maxima(std::span<const Slab> images, const Problem& problem);
/// Sum of each slice's values inside the circle.
[[nodiscard]] PerSlice sums(std::span<const Slab> images, const Problem& problem);
/// Dose statistics of each slice in use.
[[nodiscard]] std::vector<model::DoseStatistics> statistics(std::span<const Slab> dose, const Problem& problem);
/// The same of a result, as vam-score counts: what is part of a thin slice is cut by the surface.
[[nodiscard]] std::vector<model::DoseStatistics> whole_statistics(std::span<const Slab> dose, const Problem& problem,
                                                                  std::optional<double> threshold = std::nullopt);
/// Statistics of the voxels that the surface cuts, as part from half coverage on, else void; without those that are
/// constrained (Demands::surface).
[[nodiscard]] std::vector<model::DoseStatistics> cut_statistics(std::span<const Slab> dose, const Problem& problem);

/// Figures of each slice in use. Of a grey target: ver = share of the voxels whose response is outside its tolerance,
/// pw, and latitude, = the least margin that any has to the edge of it, negative when outside, ipdr = largest error, cv
/// = root mean square error, iou = 1 - ver.
[[nodiscard]] std::vector<model::DoseMetrics> metrics(std::span<const Slab> dose, const Problem& problem);

/// IoU + latitude: IoU moves while part and void overlap, latitude when they have come apart.
[[nodiscard]] inline double merit(const model::DoseMetrics& slice) { return slice.iou + slice.latitude; }

/// The factor for each slice that puts window.threshold() in the middle of the slice's own process window or, where
/// that window is wider than needed, its least part dose on window.high; 0 for a slice without part. This is what makes
/// one threshold dose print all slices. Grey targets are doses already: 1.
[[nodiscard]] PerSlice to_common_threshold(const std::vector<model::DoseMetrics>& slices, const Problem& problem);
/// The same for slices that share light: one factor, of all of them together.
[[nodiscard]] PerSlice to_shared_threshold(std::span<const Slab> dose, const Problem& problem);
/// Figures of all slices in use as one body.
[[nodiscard]] model::DoseMetrics body_metrics(std::span<const Slab> dose, const Problem& problem);

}  // namespace vam::optimize
