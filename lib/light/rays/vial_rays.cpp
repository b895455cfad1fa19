// SPDX-License-Identifier: GPL-3.0-or-later
#include "light/rays/vial_rays.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>

#include "base/compute/simd.hpp"
#include "base/compute/slab_lanes.hpp"
#include "base/constants.hpp"
#include "base/error.hpp"
#include "base/text/text.hpp"
#include "model/absorption.hpp"
#include "model/circle.hpp"
#include "optics/skew_ray.hpp"
#include "tomo/axis_transmission.hpp"

namespace vam::light {

namespace {

double farthest_mm(const VialSetup& setup) {
  const model::Grid& grid = setup.grid;
  const double x = std::max(std::abs(grid.x_mm(0)), std::abs(grid.x_mm(grid.nx - 1)));
  const double y = std::max(std::abs(grid.y_mm(0)), std::abs(grid.y_mm(grid.ny - 1)));
  return std::min(setup.radius_mm, std::hypot(x, y));
}

}  // namespace

/// Slabs are looked up whole. Slices that no row reaches in any pose need no rays.
double VialRays::top_mm() const {
  const int slices = (setup_.grid.nz + lanes - 1) / lanes * lanes;
  const model::LiftRange lift = model::lift_mm(setup_.poses);
  const double top = std::max(std::abs(height_mm(0) + lift.least), std::abs(height_mm(slices - 1) + lift.most));
  if (!posed()) return top;
  constexpr double lower = 1.25;  // light may cross a slice that its row is far above
  const double rows_mm = std::max(std::abs(std::max(setup_.lowest_mm, row_mm(0))),
                                  std::abs(std::min(setup_.highest_mm, row_mm(setup_.rows - 1))));
  return std::min(top, lower * rows_mm + 4 * lanes * setup_.grid.voxel_mm);
}

RayTable::Scope VialRays::table_scope() const {
  constexpr double least_height_mm = 1e-3;
  RayTable::Scope table;
  table.view = setup_.view;
  table.angles = round_int(turn_rad / std::abs(setup_.turn.step_rad));
  table.sense = sense();
  table.absorption_per_mm = setup_.absorption_per_mm;
  table.r_max_mm = farthest_mm(setup_) + model::farthest_mm(setup_.poses, model::Moves::part);
  table.voxel_mm = setup_.grid.voxel_mm;
  table.height_mm = std::max(top_mm(), least_height_mm);
  return table;
}

VialRays::VialRays(const VialSetup& setup)
    : setup_(completed(setup)), table_(RayTable::of(table_scope())), widths_(setup_) {
  tomo::require_translucent(setup_.absorption_per_mm, optics::resin_radius_mm(setup_.view));
  if (posed()) posed_ = PosedRays(setup_, sense(), *table_);
  note_columns();
  note_rows();
  RayNodes level;
  table_->at_height(0, scale(), widths_, level);
  float widest2 = 0;  // of a box as variable as a shadow
  for (const RayNode& node : level) widest2 = std::max(widest2, node.edge * node.edge + node.spread2);
  taps_ = ceil_int(std::numbers::sqrt2 * std::sqrt(widest2)) + 1;
  require_moderate_rays(level);
  note_spread();
  for (int a = 0; a < setup_.turn.rows; ++a) {
    const double theta = setup_.part_angle_rad(a);
    cosines_.push_back(static_cast<float>(std::cos(theta)));
    sines_.push_back(static_cast<float>(std::sin(theta)));
  }
}

/// From the first to the last one that lights the circle in any pose.
void VialRays::note_columns() {
  const double resin_mm = optics::resin_radius_mm(setup_.view);
  const double circle_mm =
      setup_.radius_mm + setup_.grid.voxel_mm + model::farthest_mm(setup_.poses, model::Moves::part);
  const double off_mm = model::farthest_mm(setup_.poses, model::Moves::vial);
  const auto lights = [&](double x_p_mm) {
    const optics::ChiefRay ray = optics::chief_ray(setup_.view, x_p_mm);
    return ray.hits && std::abs(ray.x_v_mm) <= circle_mm;
  };
  for (int c = 0; c < setup_.projector.columns; ++c) {
    const double x_p = setup_.projector.x_mm(c);
    // A vial that moves along the light changes where its columns are by less than it moves.
    if (!lights(x_p) && !(off_mm > 0 && (lights(x_p - 1.5 * off_mm) || lights(x_p + 1.5 * off_mm)))) continue;
    const optics::ChiefRay ray = optics::chief_ray(setup_.view, x_p);
    if (transmitted_.empty()) first_ = c;
    const double depth_mm = model::half_chord(resin_mm, ray.x_v_mm);
    transmitted_.push_back(ray.transmittance * model::transmitted(setup_.absorption_per_mm, depth_mm));
  }
  if (!transmitted_.empty()) return;
  throw Error{Fault::data, "projector: none of its " + std::to_string(setup_.projector.columns) +
                               " columns reaches the resin; check projector.axis_column and projector.pixel_mm"};
}

/// The widest anywhere in the circle.
void VialRays::note_spread() {
  if (!widths_.along()) return;
  double most_mm = 0;
  constexpr int directions = 360;
  for (const double r : {0.0, 0.5 * farthest_mm(setup_), farthest_mm(setup_)}) {
    for (int i = 0; i < directions; ++i) {
      const double alpha = i * turn_rad / directions;
      most_mm = std::max(most_mm, table_->spread_along_mm(r * std::cos(alpha), r * std::sin(alpha), widths_));
    }
  }
  spread_ = RowSpread(most_mm / setup_.grid.voxel_mm);
  if (spread_.most() <= most_spread_rows) return;
  throw Error{Fault::data, "projector: at half_angle_deg " + format_number(setup_.half_angle_rad * deg_per_rad, 3) +
                               " its light spreads over " + std::to_string(spread_.most()) +
                               " voxels along z on either side, and " + std::to_string(most_spread_rows) +
                               " can; use larger voxels, or check projector.half_angle_deg and projector.focus_mm"};
}

double VialRays::spread_rows(int i, int j, int angle) const {
  const double x = setup_.grid.x_mm(i);
  const double y = setup_.grid.y_mm(j);
  const auto c = static_cast<double>(cosines_[static_cast<std::size_t>(angle)]);
  const auto s = static_cast<double>(sines_[static_cast<std::size_t>(angle)]);
  return table_->spread_along_mm(x * c + y * s, y * c - x * s, widths_) / setup_.grid.voxel_mm;
}

void VialRays::note_rows() {
  const double voxel = setup_.grid.voxel_mm;
  const auto row_at = [&](double z_mm) {
    return std::clamp((z_mm - setup_.first_row_mm) / voxel, -1.0, static_cast<double>(setup_.rows));
  };
  first_row_ = std::max(0, ceil_int(row_at(setup_.lowest_mm) - 0.01));
  end_row_ = std::min(setup_.rows, floor_int(row_at(setup_.highest_mm) + 0.01) + 1);
  if (!posed()) return;
  constexpr float spare = 0.05F;  // for heights and displaced vials
  least_row_ = 1e9F;
  most_row_ = 0;
  for (int row = 0; row < table_->inner.rows; ++row) {
    const TableNode* points = table_->points(table_->inner, row, 0);
    for (int i = 0; i < table_->directions; ++i) {
      least_row_ = std::min(least_row_, (1 - spare) * points[i].row[0]);
      most_row_ = std::max(most_row_, (1 + spare) * points[i].row[0]);
    }
  }
}

bool VialRays::lit(int first, int slices, int frame) const {
  const double bottom = height_mm(first) + posed_.lift_mm(frame);
  const double top = height_mm(first + slices - 1) + posed_.lift_mm(frame);
  const auto least = static_cast<double>(least_row_);
  const auto most = static_cast<double>(most_row_);
  return top * (top > 0 ? most : least) > row_mm(first_row_ - 1 - spread_.most()) &&
         bottom * (bottom > 0 ? least : most) < row_mm(end_row_ + spread_.most());
}

/// Light of a row falls on the next slices, too, and rays are interpolated between nodes.
RowRange VialRays::rows_to(const RayNodes& nodes, int first, int slices) const {
  if (posed()) return posed_rows_to(first, slices);
  float low = std::numeric_limits<float>::max();
  float high = std::numeric_limits<float>::lowest();
  for (const RayNode& node : nodes) {
    const float half = 0.5F * static_cast<float>(slices - 1) * node.zoom;
    low = std::min(low, node.row - half);
    high = std::max(high, node.row + half);
  }
  const int more = spread_.most();
  return {std::clamp(floor_int(low) - 1 - more, first_row_, end_row_),
          std::clamp(ceil_int(high) + 2 + more, first_row_, end_row_)};
}

RowRange VialRays::posed_rows_to(int first, int slices) const {
  const auto least = static_cast<double>(least_row_);
  const auto most = static_cast<double>(most_row_);
  const model::LiftRange lift = model::lift_mm(setup_.poses);
  const double bottom = height_mm(first) + lift.least;
  const double top = height_mm(first + slices - 1) + lift.most;
  const int more = spread_.most();
  const auto row_at = [&](double z_mm) {
    return std::clamp((z_mm - setup_.first_row_mm) / setup_.grid.voxel_mm, -2.0 - more, setup_.rows + 2.0 + more);
  };
  return {std::clamp(floor_int(row_at(bottom * (bottom > 0 ? least : most))) - 1 - more, first_row_, end_row_),
          std::clamp(ceil_int(row_at(top * (top > 0 ? most : least))) + 2 + more, first_row_, end_row_)};
}

HeightScale VialRays::posed_scale(int first, int slices, int frame) const {
  return table_->scale_at(height_mm(first + 0.5 * (slices - 1)) + posed_.lift_mm(frame), scale());
}

void VialRays::find_posed_taps(const RayNodes& nodes, int count, int frame, int slices, RayTaps& taps) const {
  static const std::vector<RaySource> own = [] {
    std::vector<RaySource> sources;
    for (int e = 0; e < ray_block * most_blocks; ++e) sources.push_back({e, e, 0, 0, 0});
    return sources;
  }();
  constexpr int one = 1;
  take_from(nodes, own.data(), count, {0, 0, one, cosines_[frame], sines_[frame]}, slices, taps);
}

/// The row kernels hold a tile's rows: 64 slices under the largest zoom, and what the rays climb across the tile.
void VialRays::require_moderate_rays(RayNodes& nodes) const {
  if (!table_->climbs()) return;
  constexpr float least_zoom = 0.55F, largest_zoom = 1.85F;
  constexpr double steepest = 1.7;
  const double top = top_mm();
  float low = 1, high = 1;
  for (const double z : {0.0, top}) {
    table_->at_height(z, scale(), widths_, nodes);
    for (const RayNode& node : nodes) {
      low = std::min(low, node.zoom);
      high = std::max(high, node.zoom);
    }
  }
  const double climb = std::abs(optics::skew_ray(setup_.view, 0, top).climb);
  const std::string lens = "projector: its lens, " + format_number(*setup_.view.rows_lens_mm, 4) +
                           " mm from the axis, is too close to the axis: ";
  const std::string remedy = "; check projector.throw_ratio and projector.lens_distance_mm";
  if (climb > steepest) {
    throw Error{Fault::data, lens + "rays climb by " + format_number(climb, 3) + " mm per mm, at most " +
                                 format_number(steepest) + " supported" + remedy};
  }
  if (low >= least_zoom && high <= largest_zoom) return;
  const auto number = [](float v) { return format_number(v, 3); };
  throw Error{Fault::data, lens + "across the vial rows are " + number(low) + " to " + number(high) +
                               " times as dense as on the axis, at least " + number(least_zoom) + " and at most " +
                               number(largest_zoom) + " supported" + remedy};
}

int VialRays::chunk(double r_mm) const {
  constexpr int widest = 4 * lanes;
  constexpr double columns = 0.12;
  if (!climbs()) return widest;
  const double top = top_mm();
  int slices = widest;
  while (slices > lanes) {
    const double middle = std::max(0.0, top - 0.5 * slices * setup_.z_scale * setup_.grid.voxel_mm);
    if (table_->drift_mm(middle, top, r_mm) < columns * setup_.projector.pixel_mm) break;
    slices /= 2;
  }
  return slices;
}

int VialRays::find(int i, int j, RaySource* rays) const {
  const double x = setup_.grid.x_mm(i);
  const double y = setup_.grid.y_mm(j);
  const double r = std::hypot(x, y);
  if (r > setup_.radius_mm || r >= table_->edge_mm) return 0;
  const bool outside = r > table_->inner_edge_mm;
  if (outside && table_->outer.rows == 0) return 0;
  const RayTable::Zone& zone = outside ? table_->outer : table_->inner;
  const RayTable::RowPair rows = zone.rows_at(r);
  // alpha = psi - theta: the voxel seen from the lab. In steps of the table, increasing with the row.
  const double theta = setup_.part_angle_rad(0);
  double alpha = sense() * (std::atan2(y, x) - theta) / turn_rad;
  alpha = (alpha - std::floor(alpha)) * table_->directions;
  const int index = std::min(static_cast<int>(alpha), table_->directions - 1);
  for (int sheet = 0; sheet < zone.sheets; ++sheet) {
    rays[sheet] = {static_cast<int>(table_->row_begin(zone, rows.low, sheet)),
                   static_cast<int>(table_->row_begin(zone, rows.high, sheet)), index, rows.part,
                   static_cast<float>(alpha - index)};
  }
  return zone.sheets;
}

int VialRays::quarters() const {
  const model::Grid& grid = setup_.grid;
  const double off_mm =
      std::max(std::abs(grid.x_mm(0) + grid.x_mm(grid.nx - 1)), std::abs(grid.y_mm(0) + grid.y_mm(grid.ny - 1)));
  const bool square = grid.nx == grid.ny && off_mm < 1e-6 * grid.voxel_mm;
  return square && !posed() && setup_.turn.rows % 4 == 0 ? 4 : 1;
}

int VialRays::turned_angle(int angle, int quarters) const {
  const int angles = setup_.turn.rows;
  return (angle - sense() * quarters * (angles / 4) + angles) % angles;
}

RayScale VialRays::scale() const {
  const double pixel = setup_.projector.pixel_mm;
  const double voxel = setup_.grid.voxel_mm;
  return {1 / pixel,      setup_.projector.axis_column - first_ + padding(),
          1 / voxel,      -setup_.first_row_mm / voxel,
          setup_.z_scale, voxel / pixel};
}

void VialRays::at_slices(int first, int slices, RayNodes& nodes) const {
  table_->at_height(climbs() ? height_mm(first + 0.5 * (slices - 1)) : 0, scale(), widths_, nodes);
}

void VialRays::take_from(const RayNodes& nodes, const RaySource* rays, int count, const PartTurn& part, int slices,
                         RayTaps& taps) const {
  static const auto kernel = VAM_KERNEL(find_taps, simd_level());
  const RayFrame frame{part.shift,
                       part.step,
                       part.directions,
                       part.cosine,
                       part.sine,
                       static_cast<float>(columns() + 2 * padding() - 1),
                       climbs() ? 0.5F * static_cast<float>(slices - 1) : 0.0F,
                       widths_.across(),
                       taps_};
  kernel(nodes.data(), rays, count, frame, taps);
}

void VialRays::find_taps(const RayNodes& nodes, const RaySource* rays, int count, int angle, int slices,
                         RayTaps& taps) const {
  const auto a = static_cast<std::size_t>(angle);
  take_from(nodes, rays, count, {angle * table_->phases, table_->phases, table_->directions, cosines_[a], sines_[a]},
            slices, taps);
}

}  // namespace vam::light
