#include "vam-score/inputs.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "base/error.hpp"
#include "base/text.hpp"

namespace vam::score_tool {

namespace {

Inputs read_grids(const Options& options) {
  Inputs in;
  if (!options.target.empty()) {
    in.volumes.push_back(io::read_volume(options.input, options.grid));
    in.volumes.push_back(io::read_volume(options.target, "target"));
    in.target_at = 1;
    return in;
  }
  in.volumes = io::read_volumes(options.input);
  const auto find = [&](const std::string& name, const std::string& remedy) {
    for (std::size_t i = 0; i < in.volumes.size(); ++i) {
      if (in.volumes[i].name() == name) return i;
    }
    throw Error{Fault::data, options.input + ": has no grid '" + name + "'; " + remedy};
  };
  in.dose_at = find(options.grid, "select the grid with --grid");
  in.target_at = find("target", "give the target's file with --target");
  return in;
}

void check_same_place(const Options& options, const model::Grid& dose, const model::Grid& target) {
  const auto text = [](const model::Grid& g) {
    return std::to_string(g.nx) + " x " + std::to_string(g.ny) + " x " + std::to_string(g.nz) + " voxels of " +
           format_number(g.voxel_mm) + " mm from (" + format_number(g.origin_mm[0]) + ", " +
           format_number(g.origin_mm[1]) + ", " + format_number(g.origin_mm[2]) + ")";
  };
  const double slack = 1e-3 * target.voxel_mm;
  bool same = dose.nx == target.nx && dose.ny == target.ny && dose.nz == target.nz &&
              std::abs(dose.voxel_mm - target.voxel_mm) <= slack / std::max({dose.nx, dose.ny, dose.nz, 1});
  for (std::size_t axis = 0; axis < 3; ++axis)
    same = same && std::abs(dose.origin_mm[axis] - target.origin_mm[axis]) <= slack;
  if (!same) {
    throw Error{Fault::data, options.input + ": the dose has " + text(dose) + ", but the target has " + text(target) +
                                 "; compute the dose on the grid of this target"};
  }
}

}  // namespace

Inputs read(const Options& options) {
  Inputs in = read_grids(options);
  check_same_place(options, in.dose().grid(), in.target().grid());
  return in;
}

}  // namespace vam::score_tool
