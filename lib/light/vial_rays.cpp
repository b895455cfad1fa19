#include "light/vial_rays.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "base/constants.hpp"
#include "base/error.hpp"
#include "base/log.hpp"
#include "base/simd.hpp"
#include "base/text.hpp"
#include "optics/resample_stack.hpp"

namespace vam::light {

namespace {

constexpr double turn_rad = 2 * std::numbers::pi;
constexpr double rows_per_voxel = 2;  // of the table's radii

decltype(&baseline::vial_taps) pick_taps() {
#if defined(__x86_64__)
  if (simd_level() == Simd::avx512) return avx512::vial_taps;
  if (simd_level() == Simd::avx2) return avx2::vial_taps;
#endif
  return baseline::vial_taps;
}

VialSetup checked(const VialSetup& setup) {
  const double covered = setup.turn.rows * std::abs(setup.turn.step_rad);
  if (setup.turn.rows < 1 || !(std::abs(covered - turn_rad) < 0.01 * std::abs(setup.turn.step_rad))) {
    throw Error{Fault::data, "sinogram: its " + std::to_string(setup.turn.rows) + " angles cover " +
                                 format_number(covered * deg_per_rad) + " deg; the vial needs exactly one turn"};
  }
  return setup;
}

/// Symmetric weights of a box of this variance (in columns^2), the middle one at index size / 2: m whole columns on
/// either side and a part e of the next, from variance (2 m + 1 + 2 e) = 2 (1 + 4 + ... + m^2) + 2 e (m + 1)^2.
std::vector<float> box(double variance) {
  int m = 0;
  while ((m + 1.0) * (m + 2.0) / 3 < variance) ++m;  // the next whole box is still narrower
  const double squares = m * (m + 1) * (2 * m + 1) / 3.0;
  const double part = (variance * (2 * m + 1) - squares) / (2 * ((m + 1.0) * (m + 1.0) - variance));
  std::vector<float> weights(static_cast<std::size_t>(2 * m + 3), static_cast<float>(1 / (2 * m + 1 + 2 * part)));
  weights.front() *= static_cast<float>(part);
  weights.back() = weights.front();
  return weights;
}

/// `weights` centred on `column`, cut to columns [0, columns).
VialRays::Shadow cut(const std::vector<float>& weights, int column, int columns) {
  const int half = static_cast<int>(weights.size()) / 2;
  const int first = std::max(column - half, 0);
  const int last = std::min(column + half, columns - 1);
  const auto begin = weights.begin() + (first - (column - half));
  return {first, {begin, begin + (last - first + 1)}};
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
  for (const int edge : {0, setup.projector.columns - 1}) {
    const optics::ChiefRay ray = optics::chief_ray(setup.view, setup.projector.x_mm(edge));
    if (ray.hits) setup.radius_mm = std::min(setup.radius_mm, std::abs(ray.x_v_mm));
  }
  return setup;
}

VialRays::VialRays(const VialSetup& setup)
    : setup_(checked(setup)),
      table_(setup_.view, setup_.turn.rows, sense(), setup_.absorption_per_mm,
             std::min(setup_.radius_mm, 0.999 * optics::reach_mm(setup_.view)), setup_.grid.voxel_mm / rows_per_voxel),
      make_taps_(pick_taps()) {
  std::vector<std::vector<float>> boxes;
  const double resin_mm = optics::resin_radius_mm(setup_.view);
  for (int c = 0; c < setup_.projector.columns; ++c) {
    const optics::ChiefRay ray = optics::chief_ray(setup_.view, setup_.projector.x_mm(c));
    if (!ray.hits || std::abs(ray.x_v_mm) > setup_.radius_mm + setup_.grid.voxel_mm) continue;
    if (boxes.empty()) first_ = c;
    const double width = setup_.grid.voxel_mm / (ray.jacobian * setup_.projector.pixel_mm);  // of a voxel, in columns
    boxes.push_back(box(width * width / 12));  // a square's shadow has this variance from every side
    const double depth_mm = std::sqrt(std::max(0.0, resin_mm * resin_mm - ray.x_v_mm * ray.x_v_mm));
    transmitted_.push_back(ray.transmittance * std::exp(-setup_.absorption_per_mm * depth_mm));
  }
  if (boxes.empty()) {
    throw Error{Fault::data, "projector: none of its " + std::to_string(setup_.projector.columns) +
                                 " columns lights the resin; check projector.axis_column and projector.pixel_mm"};
  }
  const int count = static_cast<int>(boxes.size());
  for (int c = 0; c < count; ++c) shadows_.push_back(cut(boxes[static_cast<std::size_t>(c)], c, count));
}

bool VialRays::find(int i, int j, Voxel& voxel) const {
  const double x = setup_.grid.x_mm(i);
  const double y = setup_.grid.y_mm(j);
  const double r = std::hypot(x, y);
  if (r > setup_.radius_mm || r >= table_.reach_mm) return false;
  const light::LitTable::Zone& zone = table_.inner;
  const double place = r / zone.pitch_mm;
  const int low = std::min(static_cast<int>(place), zone.rows - 2);
  // alpha = psi - theta: the voxel seen from the lab. In steps of the table, increasing with the row.
  const double theta = setup_.direction * setup_.turn.start_rad + setup_.angle_offset_rad;
  const int directions = table_.angles * table_.phases;
  double alpha = sense() * (std::atan2(y, x) - theta) / turn_rad;
  alpha = (alpha - std::floor(alpha)) * directions;
  const int index = std::min(static_cast<int>(alpha), directions - 1);
  voxel.source.radius_part = static_cast<float>(std::min(place - low, 1.0));
  voxel.source.direction_part = static_cast<float>(alpha - index);
  for (const int corner : {0, 1, 2, 3}) {
    const int at = index + corner % 2;
    const std::size_t series =
        table_.series(zone, low + corner / 2, 0, at % table_.phases) + static_cast<std::size_t>(at / table_.phases);
    voxel.source.x_p_mm[corner] = zone.x_p_mm.data() + series;
    voxel.source.strength[corner] = zone.strength.data() + series;
  }
  return true;
}

void VialRays::taps(const Voxel& voxel, int row, int rows, VialTaps& taps) const {
  VialSource source = voxel.source;
  for (const int corner : {0, 1, 2, 3}) {
    source.x_p_mm[corner] += row;
    source.strength[corner] += row;
  }
  const VialColumns columns{static_cast<float>(1 / setup_.projector.pixel_mm),
                            static_cast<float>(setup_.projector.axis_column - first_ + padding),
                            static_cast<float>(row_stride() - 2), row_stride()};
  make_taps_(source, columns, rows, taps);
}

}  // namespace vam::light
