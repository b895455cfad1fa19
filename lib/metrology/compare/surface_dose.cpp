// SPDX-License-Identifier: GPL-3.0-or-later
#include "metrology/compare/surface_dose.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "base/error.hpp"
#include "base/stats/median.hpp"
#include "base/text/json.hpp"
#include "base/text/text.hpp"
#include "model/value_at.hpp"
#include "solid/mesh/geometry.hpp"
#include "solid/mesh/surface_samples.hpp"

namespace vam::metrology {

namespace {

constexpr int surface_samples = 40000;
constexpr std::size_t octants = 8;  // of the bounding box: what is wrong with one side differs between them
constexpr double most_beyond = 0.1;

std::size_t octant(const Vector3& point, const Vector3& centre) {
  std::size_t which = 0;
  for (std::size_t d = 0; d < 3; ++d) which = 2 * which + (point[d] > centre[d] ? 1 : 0);
  return which;
}

// A voxel's width from the edge, so that the slope is known, too.
bool is_within(const model::Grid& g, const Vector3& at) {
  const std::array<double, 3> first{g.x_mm(1), g.y_mm(1), g.z_mm(1)};
  const std::array<double, 3> last{g.x_mm(g.nx - 2), g.y_mm(g.ny - 2), g.z_mm(g.nz - 2)};
  for (std::size_t d = 0; d < 3; ++d) {
    if (at[d] < first[d] || at[d] > last[d]) return false;
  }
  return true;
}

double slope_at(const model::Volume& dose, const Vector3& at, const Vector3& normal, double stretch_z) {
  const double step = dose.grid.voxel_mm;
  const auto along = [&](double way) {
    return static_cast<double>(
        model::value_at(dose, at[0] + way * normal[0], at[1] + way * normal[1], at[2] + way * normal[2] * stretch_z));
  };
  return (along(-step) - along(step)) / (2 * step);
}

}  // namespace

SurfaceDose surface_dose(const model::TriangleSoup& body, const model::Volume& dose, double stretch_z,
                         const std::string& subject) {
  if (body.triangles.empty()) throw Error{Fault::data, subject + ": has no surface"};
  const auto points = solid::sample_surface(body, surface_samples);
  const Vector3 centre = solid::bounding_box(body).centre();
  std::vector<double> all, slopes;
  std::array<std::vector<double>, octants> parts;
  for (const auto& [point, normal, triangle] : points) {
    const Vector3 at{point[0], point[1], point[2] * stretch_z};
    if (!is_within(dose.grid, at)) continue;
    all.push_back(static_cast<double>(model::value_at(dose, at[0], at[1], at[2])));
    slopes.push_back(slope_at(dose, at, normal, stretch_z));
    parts[octant(point, centre)].push_back(all.back());
  }
  const double beyond = 1 - static_cast<double>(all.size()) / static_cast<double>(points.size());
  if (beyond > most_beyond) {
    throw Error{Fault::data, subject + ": " + format_number(100 * beyond, 3) +
                                 " % of its surface lies beyond the dose; align the print with the part "
                                 "(vam-sdf -o), or compute the dose on a larger grid"};
  }
  SurfaceDose result;
  const double middle = stats::median(all);
  std::vector<double> medians;
  for (const auto& part : parts) {
    if (part.size() * octants * 4 > all.size()) medians.push_back(stats::median(part));
  }
  double squares = 0;
  for (const double one : medians) squares += (one - middle) * (one - middle);
  const double count = static_cast<double>(std::max<std::size_t>(medians.size(), 2));
  result.critical_dose_mj_cm3 = {middle, std::sqrt(squares / (count - 1) / count), static_cast<int>(all.size())};
  result.spread_mj_cm3 = stats::robust_sigma(std::move(all), middle);
  result.gradient_mj_cm3_mm = stats::median(slopes);
  return result;
}

Json to_json(const SurfaceDose& result) {
  return {{"critical_dose_mj_cm3", result.critical_dose_mj_cm3.value},
          {"critical_dose_sigma_mj_cm3", result.critical_dose_mj_cm3.sigma},
          {"spread_mj_cm3", result.spread_mj_cm3},
          {"gradient_mj_cm3_mm", result.gradient_mj_cm3_mm},
          {"points", result.critical_dose_mj_cm3.n}};
}

}  // namespace vam::metrology
