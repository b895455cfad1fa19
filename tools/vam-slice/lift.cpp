// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>

#include "base/error.hpp"
#include "base/text/json.hpp"
#include "base/text/text.hpp"
#include "light/grids/blurred_faces.hpp"
#include "vam-slice/part.hpp"

namespace vam::slice_tool {

namespace {

/// Where climbing rays blur the horizontal faces of the part least.
double sharpest_mm(const model::Printer& printer, const solid::Part& part, double voxel_mm, double least_mm,
                   double most_mm) {
  const model::Grid grid = solid::grid_around(part.extent, voxel_mm, 0, part.lattice, part.subject);
  light::FlatFaceFinder finder(grid);
  solid::fill(part, grid, [&](int, int count, const float* slices) { finder.add(count, slices); });
  return light::best_lift_mm(printer, finder.faces(), voxel_mm, least_mm, most_mm);
}

/// The lifts that keep the part within the projector's rows, in voxels, with room beyond both ends if there is any: the
/// dose at an end face is the threshold only if the voxels beyond it can be lit as well.
struct Lifts {
  double least, most;
};

Lifts lifts(double least_mm, double most_mm, double voxel_mm) {
  constexpr double rounding = 1e-6;
  constexpr double beyond = 2;
  const Lifts all{std::ceil(least_mm / voxel_mm - rounding), std::floor(most_mm / voxel_mm + rounding)};
  const double spare = std::clamp(std::floor((all.most - all.least) / 2), 0.0, beyond);
  return {all.least + spare, all.most - spare};
}

double requested_mm(const Options& options) {
  const auto mm = parse_number(options.place);
  if (mm && std::isfinite(*mm)) return *mm * options.placement.stretch_z;
  throw Error{Fault::usage, "--place: '" + options.place + "' is neither a height in mm nor auto"};
}

}  // namespace

double lift_mm(const Options& options, const model::Printer& printer, const solid::Part& part,
               const solid::Writable& room) {
  const double voxel_mm = options.voxel_mm.value();
  constexpr double rounding = 1e-6;
  const double least_mm = room.low_mm - part.extent.box.low[2];
  const double most_mm = room.high_mm - part.extent.box.high[2];
  if (!options.place.empty() && options.place != "auto") {
    return std::round(requested_mm(options) / voxel_mm) * voxel_mm;
  }
  if (most_mm < least_mm - rounding) return 0;  // taller than the image
  const Lifts within = lifts(least_mm, most_mm, voxel_mm);
  if (options.place == "auto") {
    return sharpest_mm(printer, part, voxel_mm, within.least * voxel_mm, within.most * voxel_mm);
  }
  if (options.no_centre) return 0;
  return std::clamp(0.0, within.least, std::max(within.least, within.most)) * voxel_mm;
}

Json lift_figures(const Options& options, double lift_mm) {
  return {{"mm", lift_mm / options.placement.stretch_z},
          {"by", options.place.empty()     ? "default"
                 : options.place == "auto" ? "auto"
                                           : "option"}};
}

}  // namespace vam::slice_tool
