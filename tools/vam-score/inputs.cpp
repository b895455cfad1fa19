// SPDX-License-Identifier: GPL-3.0-or-later
#include "vam-score/inputs.hpp"

#include <string>

#include "base/error.hpp"
#include "grey_target.hpp"
#include "io/vdb/gate.hpp"

namespace vam::score_tool {

namespace {

Inputs read_grids(const Options& options) {
  const io::TargetKind kind = options.grey.is_target ? io::TargetKind::grey : io::TargetKind::coverage;
  Inputs in;
  if (!options.target.empty()) {
    in.volumes.push_back(io::read_volume(options.input, options.grid));
    in.volumes.push_back(io::read_volume(options.target, "target"));
    in.target_at = 1;
    io::require_usable(options.input, in.volumes[0]);
    io::require_usable(options.target, in.volumes[1], kind);
    return in;
  }
  in.volumes = io::read_volumes(options.input);
  io::require_usable(options.input, in.volumes, kind);
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

}  // namespace

Inputs read(const Options& options) {
  Inputs in = read_grids(options);
  const std::string& file = options.target.empty() ? options.input : options.target;
  if (options.grey.is_target && !(options.grey.band_volume.empty() && file == "-"))
    in.band = tool::band_of(options.grey.band_volume, file);
  in.volumes[in.target_at].extend_to(in.dose().grid(), file);  // around the target there is void
  return in;
}

}  // namespace vam::score_tool
