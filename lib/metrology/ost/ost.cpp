// SPDX-License-Identifier: GPL-3.0-or-later
#include "metrology/ost/ost.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/compute/parallel.hpp"
#include "base/compute/per_slice.hpp"
#include "base/constants.hpp"
#include "base/error.hpp"
#include "base/index.hpp"
#include "base/log/progress.hpp"
#include "base/text/text.hpp"
#include "metrology/ost/private/angle_grid.hpp"
#include "metrology/ost/private/bubbles.hpp"
#include "metrology/ost/private/camera_sinograms.hpp"
#include "metrology/ost/private/mlem.hpp"
#include "metrology/ost/private/ost_state.hpp"
#include "metrology/ost/private/specks.hpp"
#include "model/circle.hpp"
#include "model/magnification.hpp"
#include "optics/chief_ray.hpp"
#include "optics/skew_ray.hpp"
#include "optics/writable_radius.hpp"
#include "tomo/filter.hpp"

namespace vam::metrology {

namespace {

// Slices of a pass: all, if they take little memory beside views and volume; else a part of them.
int slices_a_pass(int columns, int angles) {
  constexpr std::size_t little = std::size_t{1} << 25;  // values
  constexpr std::size_t fewest = 64;
  return static_cast<int>(std::max(fewest, little / product(columns, angles)));
}

// Without refraction: the columns as they are, only brought to the virtual pitch by linear interpolation.
void rescale_columns(const Image& in, const optics::Detector& camera, const optics::Detector& detector, Image& out) {
  out = Image(detector.columns, in.height);
  for (int c = 0; c < detector.columns; ++c) {
    const double at = camera.column(detector.x_mm(c));
    const int low = floor_int(at);
    if (low < 0 || low + 1 >= in.width) continue;
    const auto f = static_cast<float>(at - low);
    for (int a = 0; a < in.height; ++a) out(c, a) = (1 - f) * in(low, a) + f * in(low + 1, a);
  }
}

void scale(std::vector<Slab>& slabs, float factor) {
  for (auto& slab : slabs) {
    for (float& value : slab.values) value *= factor;
  }
}

}  // namespace

OstReconstructor::OstReconstructor(const model::Printer& printer, double pixel_mm, int columns, int rows,
                                   const AxisPose& axis, const OstOptions& options)
    : state_(std::make_unique<State>()) {
  constexpr int fewest = 4;  // of the interpolation between pixels
  if (columns < fewest || rows < fewest) {
    throw Error{Fault::data, "views: have " + std::to_string(columns) + " x " + std::to_string(rows) +
                                 " pixels after binning; at least 4 x 4 are needed"};
  }
  State& s = *state_;
  s.options = options;
  s.axis = axis;
  s.eye = {optics::camera_view(printer),
           {columns, pixel_mm, axis.column},
           options.axis_row.value_or(0.5 * (rows - 1)),
           rows};
  s.absorption_per_mm = printer.camera.absorption_per_mm;
  s.azimuth_rad = printer.camera.azimuth_deg * rad_per_deg;
  s.direction = printer.stage.direction;
  const double voxel_mm = options.voxel_mm > 0 ? options.voxel_mm : pixel_mm;
  const int half = s.half_width(voxel_mm);
  s.detector = optics::centred_detector(2 * half + 1, voxel_mm);
  const double row_mm = pixel_mm / model::camera_magnification(printer);
  const int slices = std::max(1, floor_int(rows * row_mm / voxel_mm));
  const double middle_mm = (s.eye.axis_row - 0.5 * (rows - 1)) * row_mm;
  s.grid = model::centred_grid(2 * half + 1, 2 * half + 1, slices, voxel_mm, middle_mm - 0.5 * (slices - 1) * voxel_mm);
}

/// Voxels on either side of the axis: as far as the camera sees, or as is requested.
int OstReconstructor::State::half_width(double voxel_mm) const {
  const int columns = eye.camera.columns;
  const double seen_mm = std::min(eye.camera.x_mm(columns - 1), -eye.camera.x_mm(0));  // the nearer edge of the frame
  const auto edge = optics::chief_ray(eye.view, std::max(0.0, seen_mm));
  const double through_vial = options.refraction ? (edge.hits ? edge.x_v_mm : optics::reach_mm(eye.view)) : seen_mm;
  const double radius_mm = options.radius_mm > 0 ? std::min(options.radius_mm, through_vial) : through_vial;
  const int half = floor_int(radius_mm / voxel_mm);
  if (half >= 2) return half;
  throw Error{Fault::data, "views: the camera sees only " + format_number(radius_mm, 3) +
                               " mm beside the axis (column " + format_number(axis.column, 5) + " of " +
                               std::to_string(columns) + "); check camera.pixel_mm and the axis"};
}

OstReconstructor::OstReconstructor(std::unique_ptr<State> state) : state_(std::move(state)) {}

OstReconstructor::~OstReconstructor() = default;

const model::Grid& OstReconstructor::grid() const { return state_->grid; }

std::vector<double> OstReconstructor::State::heights_mm(int first, int count) const {
  std::vector<double> heights;
  for (int k = first; k < first + count; ++k) heights.push_back(grid.z_mm(k));
  return heights;
}

std::vector<Image> OstReconstructor::State::steady_views(std::span<const CameraView> views, const RowOfHeight& map,
                                                         std::span<const double> heights_mm, double background,
                                                         std::span<const double> intensity) const {
  auto level = level_views(views, LevelRows(map, eye.camera.columns, eye.rows, heights_mm, axis));
  make_steady(level, background, intensity);
  undo_motion(level, motion(angles_deg(views), options.run_out_mm[0], options.run_out_mm[1]), axis.column);
  return level;
}

std::vector<Image> OstReconstructor::State::virtual_sinograms(std::span<const Image> sinograms,
                                                              std::span<const double> heights_mm) const {
  std::vector<Image> out(sinograms.size());
  if (!options.refraction) {
    parallel_for(count_of(out), [&](int k) {
      const auto i = static_cast<std::size_t>(k);
      rescale_columns(sinograms[i], eye.camera, detector, out[i]);
    });
    return out;
  }
  const int angles = sinograms.front().height;
  // A camera weighs a ray's light by what leaves the glass, T, and each pixel sees a beam as wide as J.
  const optics::ResampleOptions how{
      .fresnel = true, .jacobian = false, .angle_offset_rad = azimuth_rad, .direction = direction};
  for (std::size_t first = 0; first < sinograms.size(); first += lanes) {
    const std::size_t count = std::min<std::size_t>(lanes, sinograms.size() - first);
    const optics::View plan = optics::plan_view(eye.view, heights_mm[first + count / 2]);
    optics::resample(
        optics::plan_to_virtual(plan, eye.camera, detector, {angles, 0, 2 * std::numbers::pi / angles}, how),
        sinograms.subspan(first, count), std::span(out).subspan(first, count));
  }
  return out;
}

ClimbingRays OstReconstructor::State::rays(int angles) const {
  ClimbingRays rays{detector.columns, angles, {}, absorption_per_mm, std::numbers::pi / angles / grid.voxel_mm};
  for (int t = 0; t < detector.columns; ++t) rays.rate_per_mm.push_back(climb_rate_per_mm(eye, detector.x_mm(t)));
  return rays;
}

// Specks and bubbles; `part` of the volume is made from these heights, and their shares count by it.
void OstReconstructor::State::clean(std::vector<Image>& sinograms, std::span<const double> heights_mm, double part,
                                    CleaningReport& found) const {
  const RayMask specks = speck_rays(sinograms);
  replace_specks(specks, sinograms);
  found.speck_percent += 100 * part * share_of(specks);
  const bool same_from_both_ends = !(absorption_per_mm > 0);
  if (!same_from_both_ends) return;  // bubbles are told by their lines' other ends
  // From its other end a line climbs the other way: over 2 x it is twice its climb away, in rows of the volume.
  const double rate = climb_rate_per_mm(eye, 0);
  std::vector<int> rows;
  for (const double height : heights_mm) {
    rows.push_back(1 + ceil_int(2 * std::abs(height) * rate * detector.x_mm(detector.columns - 1) / grid.voxel_mm));
  }
  model::Grid stretch = grid;
  stretch.nz = count_of(sinograms);
  stretch.origin_mm[2] = heights_mm.front();
  const double share = remove_bubbles(this->rays(sinograms.front().height), stretch, specks, sinograms, rows);
  found.bubbles_exceed_limit = found.bubbles_exceed_limit || share > most_bubbles;
  found.bubble_percent += 100 * part * share;
}

// MLEM for a stretch of slices that filtered back-projection has begun, as if rays stayed level.
void OstReconstructor::State::refine_slices(std::span<const Image> sinograms, int first, model::Volume& volume) const {
  const auto geo = geometry(sinograms.front().height);
  const auto voxel = static_cast<float>(grid.voxel_mm);
  for (int k = 0; k < count_of(sinograms); k += lanes) {
    const int count = std::min(lanes, count_of(sinograms) - k);
    std::vector<Slab> images(1, Slab(grid.nx, grid.ny));
    pack(volume.slice(first + k), count, images[0]);
    scale(images, voxel);
    const auto measured = packed(sinograms.subspan(k, count), geo.columns, geo.angles);
    maximise_likelihood(geo, measured, options.mlem_iterations, images);
    scale(images, 1 / voxel);
    unpack(images[0], count, volume.slice(first + k));
  }
}

model::Volume OstReconstructor::reconstruct(std::span<const CameraView> views, CleaningReport* found) const {
  const State& s = *state_;
  const std::vector<double> angles_deg = metrology::angles_deg(views);
  const Turns turns(angles_deg);
  const int angles = turns.angles();
  const ClimbingRays rays = s.rays(angles);
  const int beyond = heights_beyond(rays, s.grid);
  const RowOfHeight map(s.eye);
  const tomo::Filter filter(s.detector.columns, {.window = tomo::window_from_name(s.options.window),
                                                 .alpha_per_px = s.absorption_per_mm * s.grid.voxel_mm});
  CleaningReport dirt;
  Flicker light;
  if (s.options.clean) {
    const Image mean = mean_view(views);
    dirt = even_background(mean);
    light = s.flicker(views, mean, angles_deg, dirt.background);
    dirt.flicker_percent = light.percent;
  }
  model::Volume volume{s.grid, std::vector<float>(s.grid.size())};
  Progress progress("reconstructing", s.grid.nz);
  const int most = slices_a_pass(s.eye.camera.columns, angles);
  for (int first = 0; first < s.grid.nz; first += most) {
    const int count = std::min(most, s.grid.nz - first);
    const auto heights_mm = s.heights_mm(first - beyond, count + 2 * beyond);
    auto level = s.steady_views(views, map, heights_mm, dirt.background, light.intensity);
    auto seen = camera_sinograms(level, turns);
    level.clear();
    auto sinograms = s.virtual_sinograms(seen, heights_mm);
    seen.clear();
    if (s.options.clean) s.clean(sinograms, heights_mm, static_cast<double>(count) / s.grid.nz, dirt);
    s.weigh(sinograms, heights_mm);
    auto filtered = packed(sinograms, s.detector.columns, angles);
    for (auto& slab : filtered) filter.apply(slab);
    back_project(rays, filtered, beyond, first, count, volume);
    if (s.options.non_negative) {
      for (float* v = volume.slice(first); v != volume.slice(first + count); ++v) *v = std::max(*v, 0.0F);
    }
    if (s.options.mlem_iterations > 0) {
      s.refine_slices(std::span(sinograms).subspan(beyond, count), first, volume);
    }
    progress.tick(count);
  }
  if (found != nullptr) *found = dirt;
  return volume;
}

}  // namespace vam::metrology
