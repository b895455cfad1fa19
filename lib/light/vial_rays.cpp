#include "light/vial_rays.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "base/constants.hpp"
#include "base/error.hpp"
#include "base/simd.hpp"
#include "base/slab_lanes.hpp"
#include "base/text.hpp"
#include "optics/resample_stack.hpp"
#include "optics/skew_ray.hpp"

namespace vam::light {

namespace {

constexpr double turn_rad = 2 * std::numbers::pi;

VialSetup checked(VialSetup setup) {
  const double covered = setup.turn.rows * std::abs(setup.turn.step_rad);
  if (setup.turn.rows < 1 || !(std::abs(covered - turn_rad) < 0.01 * std::abs(setup.turn.step_rad))) {
    throw Error{Fault::data, "sinogram: its " + std::to_string(setup.turn.rows) + " angles cover " +
                                 format_number(covered * deg_per_rad) + " deg; the vial needs exactly one turn"};
  }
  const double resin_mm = optics::resin_radius_mm(setup.view);
  setup.radius_mm = setup.radius_mm > 0 ? std::min(setup.radius_mm, resin_mm) : resin_mm;
  if (setup.rows == 0) {
    setup.rows = setup.grid.nz;
    setup.first_row_mm = setup.grid.z_mm(0);
  }
  return setup;
}

double farthest_mm(const VialSetup& setup) {
  const model::Grid& grid = setup.grid;
  const double x = std::max(std::abs(grid.x_mm(0)), std::abs(grid.x_mm(grid.nx - 1)));
  const double y = std::max(std::abs(grid.y_mm(0)), std::abs(grid.y_mm(grid.ny - 1)));
  return std::min(setup.radius_mm, std::hypot(x, y));
}

auto pick_taps() {
#if defined(__x86_64__)
  if (simd_level() == Simd::avx512) return &avx512::ray_taps;
  if (simd_level() == Simd::avx2) return &avx2::ray_taps;
#endif
  return &baseline::ray_taps;
}

}  // namespace

VialSetup vial_setup(const model::Printer& printer, const model::Grid& grid, int angles, double radius_mm) {
  VialSetup setup;
  setup.view = optics::projector_view(printer);
  setup.projector = optics::projector_detector(printer, {});
  setup.turn = {angles, 0, turn_rad / angles};
  setup.direction = printer.stage.direction;
  setup.absorption_per_mm = printer.resin.absorption_per_mm;
  setup.grid = grid;
  setup.radius_mm = radius_mm;
  setup.z_scale = model::vertical_magnification(printer);
  const model::Projector& p = printer.projector;
  setup.lowest_mm = (p.axis_row - (p.rows - 1)) * p.pixel_mm;
  setup.highest_mm = p.axis_row * p.pixel_mm;
  for (const int edge : {0, setup.projector.columns - 1}) {
    const optics::ChiefRay ray = optics::chief_ray(setup.view, setup.projector.x_mm(edge));
    if (ray.hits) setup.radius_mm = std::min(setup.radius_mm, std::abs(ray.x_v_mm));
  }
  return setup;
}

/// Slabs are looked up whole.
double VialRays::top_mm() const {
  const int slices = (setup_.grid.nz + lanes - 1) / lanes * lanes;
  return std::max(std::abs(height_mm(0)), std::abs(height_mm(slices - 1)));
}

RayTable::Setup VialRays::table_setup() const {
  RayTable::Setup table;
  table.view = setup_.view;
  table.angles = setup_.turn.rows;
  table.sense = sense();
  table.absorption_per_mm = setup_.absorption_per_mm;
  table.r_max_mm = farthest_mm(setup_);
  table.pitch_mm = setup_.grid.voxel_mm / (setup_.view.rows_lens_mm ? 1 : 2);
  table.height_mm = top_mm();
  return table;
}

VialRays::VialRays(const VialSetup& setup) : setup_(checked(setup)), table_(table_setup()) {
  const double resin_mm = optics::resin_radius_mm(setup_.view);
  for (int c = 0; c < setup_.projector.columns; ++c) {
    const optics::ChiefRay ray = optics::chief_ray(setup_.view, setup_.projector.x_mm(c));
    if (!ray.hits || std::abs(ray.x_v_mm) > setup_.radius_mm + setup_.grid.voxel_mm) continue;
    if (transmitted_.empty()) first_ = c;
    const double depth_mm = std::sqrt(std::max(0.0, resin_mm * resin_mm - ray.x_v_mm * ray.x_v_mm));
    transmitted_.push_back(ray.transmittance * std::exp(-setup_.absorption_per_mm * depth_mm));
  }
  if (transmitted_.empty()) {
    throw Error{Fault::data, "projector: none of its " + std::to_string(setup_.projector.columns) +
                                 " columns lights the resin; check projector.axis_column and projector.pixel_mm"};
  }
  const double voxel = setup_.grid.voxel_mm;
  const auto row_at = [&](double z_mm) {
    return std::clamp((z_mm - setup_.first_row_mm) / voxel, -1.0, static_cast<double>(setup_.rows));
  };
  first_row_ = std::max(0, static_cast<int>(std::ceil(row_at(setup_.lowest_mm) - 0.01)));
  end_row_ = std::min(setup_.rows, static_cast<int>(std::floor(row_at(setup_.highest_mm) + 0.01)) + 1);
  RayNodes level;
  table_.at_height(0, level);
  const float densest = *std::max_element(level.spacing.begin(), level.spacing.end());
  const double widest =
      std::numbers::sqrt2 * setup_.grid.voxel_mm * static_cast<double>(densest) / setup_.projector.pixel_mm;
  taps_ = static_cast<int>(std::ceil(widest)) + 1;
  const double top = top_mm();
  while (chunk_ > lanes) {
    const double half = 0.5 * chunk_ * setup_.z_scale * setup_.grid.voxel_mm;
    if (!climbs() || table_.drift_mm(std::max(0.0, top - half), top) < 0.06 * setup_.projector.pixel_mm) break;
    chunk_ /= 2;
  }
  const double climb = climbs() ? std::abs(optics::skew_ray(setup_.view, 0, top).climb) : 0;
  while (tile_ > 2 && std::numbers::sqrt2 * tile_ * climb > 0.4) tile_ /= 2;
  for (int a = 0; a < setup_.turn.rows + tap_angles; ++a) {
    const double theta =
        setup_.direction * (setup_.turn.start_rad + a * setup_.turn.step_rad) + setup_.angle_offset_rad;
    cosines_.push_back(static_cast<float>(std::cos(theta)));
    sines_.push_back(static_cast<float>(std::sin(theta)));
  }
}

int VialRays::find(int i, int j, TapSource* rays) const {
  const double x = setup_.grid.x_mm(i);
  const double y = setup_.grid.y_mm(j);
  const double r = std::hypot(x, y);
  if (r > setup_.radius_mm || r >= table_.edge_mm) return 0;
  const double last_mm = table_.inner.pitch_mm * (table_.inner.rows - 1);
  const bool outside = r > last_mm;
  if (outside && table_.outer.rows == 0) return 0;
  const RayTable::Zone& zone = outside ? table_.outer : table_.inner;
  const double place = (r - zone.first_mm) / zone.pitch_mm;
  const int low = outside ? std::clamp(static_cast<int>(std::lround(place)), 0, zone.rows - 1)
                          : std::min(static_cast<int>(place), zone.rows - 2);
  // alpha = psi - theta: the voxel seen from the lab. In steps of the table, increasing with the row.
  const double theta = setup_.direction * setup_.turn.start_rad + setup_.angle_offset_rad;
  const int directions = table_.angles * table_.phases;
  double alpha = sense() * (std::atan2(y, x) - theta) / turn_rad;
  alpha = (alpha - std::floor(alpha)) * directions;
  const int index = std::min(static_cast<int>(alpha), directions - 1);
  for (int sheet = 0; sheet < zone.sheets; ++sheet) {
    TapSource& ray = rays[sheet];
    ray.radius_part = outside ? 0.0F : static_cast<float>(std::min(place - low, 1.0));
    ray.direction_part = static_cast<float>(alpha - index);
    for (const int corner : {0, 1, 2, 3}) {
      const int at = index + corner % 2;
      ray.corner[corner] =
          static_cast<long>(table_.series(zone, low + (outside ? 0 : corner / 2), sheet, at % table_.phases) +
                            static_cast<std::size_t>(at / table_.phases));
    }
  }
  return zone.sheets;
}

void VialRays::at_slices(int first, int slices, RayNodes& nodes) const {
  table_.at_height(climbs() ? height_mm(first + 0.5 * (slices - 1)) : 0, nodes);
  constexpr std::size_t beyond = tap_angles;  // the last block of stage angles reads as far
  for (auto* values :
       {&nodes.x_p_mm, &nodes.z_p_mm, &nodes.zoom, &nodes.strength, &nodes.spacing, &nodes.cosine, &nodes.sine}) {
    values->resize(values->size() + beyond, 0.0F);
  }
}

void VialRays::taps(const RayNodes& nodes, const TapSource& ray, int row, Taps& taps) const {
  static const auto kernel = pick_taps();
  const TapNodes arrays{nodes.x_p_mm.data() + row,  climbs() ? nodes.z_p_mm.data() + row : nullptr,
                        nodes.zoom.data() + row,    nodes.strength.data() + row,
                        nodes.spacing.data() + row, nodes.cosine.data() + row,
                        nodes.sine.data() + row};
  const auto pixel = setup_.projector.pixel_mm;
  const auto voxel = setup_.grid.voxel_mm;
  const TapFrame frame{static_cast<float>(1 / pixel),
                       static_cast<float>(setup_.projector.axis_column - first_ + padding()),
                       static_cast<float>(columns() + 2 * padding() - 1),
                       static_cast<float>(1 / voxel),
                       static_cast<float>(-setup_.first_row_mm / voxel),
                       static_cast<float>(setup_.z_scale),
                       static_cast<float>(voxel / pixel),
                       taps_,
                       cosines_.data() + row,
                       sines_.data() + row};
  kernel(arrays, ray, frame, taps);
}

}  // namespace vam::light
