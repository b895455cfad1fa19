// SPDX-License-Identifier: GPL-3.0-or-later
#include "vam-score/inputs.hpp"

#include <string>
#include <utility>
#include <vector>

#include "session/volumes.hpp"

namespace vam::score_tool {

Inputs read(const Options& options) {
  const bool apart = !options.target.empty();
  const std::string& file = apart ? options.target : options.input;
  Inputs in;
  if (apart) {
    in.of_dose.push_back(io::read_volume(options.input, options.grid));
    io::require_usable(options.input, in.of_dose);
  }
  in.of_target = session::read_grids(file, options.grey.is_target ? io::TargetKind::grey : io::TargetKind::coverage);
  in.dose = apart ? &in.of_dose.front()
                  : &session::require_grid(in.of_target, options.grid, file, "select the grid with --grid");
  io::SparseVolume& target = session::require_grid(
      in.of_target, "target", file, apart ? "vam-slice writes one" : "give the target's file with --target");
  in.target = &target;
  if (!options.grey.band_volume.empty()) {
    in.of_band.push_back(session::read_grid(options.grey.band_volume, "tolerance"));
    in.band = &in.of_band.front();
  } else if (options.grey.is_target) {
    in.band = session::find_grid(in.of_target, "tolerance");
  }
  target.extend_to(in.dose->grid(), file);  // around the target there is void
  return in;
}

}  // namespace vam::score_tool
