// SPDX-License-Identifier: GPL-3.0-or-later
#include "vam-optimize/faces.hpp"

#include <algorithm>
#include <string>
#include <vector>

#include "base/log/log.hpp"
#include "base/text/json.hpp"
#include "base/text/text.hpp"
#include "io/stream/stream.hpp"
#include "io/vdb/vdb.hpp"
#include "light/grids/blurred_faces.hpp"
#include "model/dose/dose_metrics.hpp"
#include "model/magnification.hpp"
#include "model/rows.hpp"

namespace vam::optimize_tool {

namespace {

std::vector<light::FlatFace> faces_of(const io::SparseVolume& target) {
  const model::Grid& grid = target.grid();
  light::FlatFaceFinder finder(grid);
  std::vector<float> slice(grid.slice_size());
  for (int k = 0; k < grid.nz; ++k) {
    target.read_slices(k, 1, slice.data());
    finder.add(1, slice.data());
  }
  return finder.faces();
}

/// The part's middle and how far it may be lifted from where it is.
struct LiftLimits {
  double middle_mm, least_mm, most_mm;
};

LiftLimits lift_limits(const io::SparseVolume& target, const model::Projector& projector) {
  const model::VoxelBox box = io::covered_box(target, model::coverage_rounding);
  const double low_mm = target.grid().z_mm(box.low[2] - 0.5);
  const double high_mm = target.grid().z_mm(box.high[2] + 0.5);
  return {0.5 * (low_mm + high_mm), std::min(0.0, model::z_mm(projector, projector.rows - 0.5) - low_mm),
          std::max(0.0, model::z_mm(projector, -0.5) - high_mm)};
}

void warn_of(const std::vector<light::BlurredFace>& hard, const light::FaceRemedy& remedy, double place_mm,
             double scale, const std::string& input) {
  const auto& worst = *std::max_element(hard.begin(), hard.end(),
                                        [](const auto& a, const auto& b) { return a.blur_voxels < b.blur_voxels; });
  const std::string lift = remedy.blur_voxels < 0.9 * worst.blur_voxels
                               ? "vam-slice --place " + format_number(place_mm, 3) + " reduces this to " +
                                     format_number(remedy.blur_voxels, 2) + ", "
                               : "";
  warn(input + ": climbing rays blur " + std::to_string(hard.size()) + " horizontal face" +
       (hard.size() > 1 ? "s" : "") + " of the part, most severely the " + (worst.face.up ? "upper" : "lower") +
       " face at z = " + format_number(scale * worst.face.z_mm, 4) + " mm, " + format_number(worst.face.width_mm, 3) +
       " mm wide, over " + format_number(worst.blur_voxels, 2) + " voxels (" + std::to_string(worst.wrong_voxels) +
       " wrong voxels); " + lift + "--rotate " + format_number(remedy.tilt_deg) +
       ",0,0 tilts the faces out of the rays");
}

}  // namespace

void add_blurred_faces(Json& report, const optimize::VolumeOutcome& outcome, const session::Scene& scene,
                       const io::SparseVolume& target, const Options& options) {
  if (outcome.wrong.empty() || !scene.poses.empty()) return;
  const double scale = model::vertical_magnification(scene.printer);
  const double voxel_mm = scene.grid.voxel_mm;
  report["blurred_faces"] = Json::array();
  if (std::all_of(outcome.wrong.begin(), outcome.wrong.end(), [](auto n) { return n == 0; })) return;
  const std::vector<light::FlatFace> faces = faces_of(target);
  const auto hard = light::blurred_faces(scene.printer, scene.grid, outcome.wrong, faces);
  if (hard.empty()) return;
  const LiftLimits limits = lift_limits(target, scene.printer.projector);
  const auto remedy = light::face_remedy(scene.printer, faces, hard, voxel_mm, limits.least_mm, limits.most_mm);
  for (const light::BlurredFace& one : hard) {
    report["blurred_faces"].push_back({{"z_mm", scale * one.face.z_mm},
                                       {"faces", one.face.up ? "up" : "down"},
                                       {"width_mm", one.face.width_mm},
                                       {"area_mm2", one.face.area_mm2},
                                       {"blur_voxels", one.blur_voxels},
                                       {"wrong_voxels", one.wrong_voxels}});
  }
  const double place_mm = scale * (limits.middle_mm + remedy.lift_mm);
  report["blurred_faces_remedy"] = {
      {"place_mm", place_mm}, {"blur_voxels", remedy.blur_voxels}, {"tilt_deg", remedy.tilt_deg}};
  warn_of(hard, remedy, place_mm, scale, io::input_name(options.input));
}

}  // namespace vam::optimize_tool
