// SPDX-License-Identifier: GPL-3.0-or-later
#include "vam-score/inputs.hpp"

#include <optional>
#include <string>
#include <utility>

#include "base/error.hpp"
#include "io/vdb/gate.hpp"
#include "own_grid.hpp"

namespace vam::score_tool {

namespace {

std::optional<std::size_t> place_of(const std::vector<io::SparseVolume>& volumes, const std::string& name) {
  for (std::size_t i = 0; i < volumes.size(); ++i) {
    if (volumes[i].name() == name) return i;
  }
  return std::nullopt;
}

/// The target, and what stands beside a grey one.
void add_target(const Options& options, io::TargetKind kind, Inputs& in) {
  if (!options.grey.is_target) {
    in.volumes.push_back(io::read_volume(options.target, "target"));
    in.target_at = in.volumes.size() - 1;
    return io::require_usable(options.target, in.volumes.back(), kind);
  }
  std::vector<io::SparseVolume> all = io::read_volumes(options.target);
  io::require_usable(options.target, all, kind);
  const auto target = place_of(all, "target");
  if (!target) throw Error{Fault::data, options.target + ": has no grid 'target'"};
  in.target_at = in.volumes.size() + *target;
  for (io::SparseVolume& volume : all) in.volumes.push_back(std::move(volume));
}

Inputs read_grids(const Options& options) {
  const io::TargetKind kind = options.grey.is_target ? io::TargetKind::grey : io::TargetKind::coverage;
  Inputs in;
  if (!options.target.empty()) {
    in.volumes.push_back(io::read_volume(options.input, options.grid));
    io::require_usable(options.input, in.volumes[0]);
    add_target(options, kind, in);
    return in;
  }
  in.volumes = io::read_volumes(options.input);
  io::require_usable(options.input, in.volumes, kind);
  const auto find = [&](const std::string& name, const std::string& remedy) {
    if (const auto place = place_of(in.volumes, name)) return *place;
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
  if (!options.grey.band_volume.empty()) {
    in.volumes.push_back(tool::read_own(options.grey.band_volume, "tolerance"));
    in.band_at = in.volumes.size() - 1;
  } else if (options.grey.is_target) {
    in.band_at = place_of(in.volumes, "tolerance");
  }
  in.volumes[in.target_at].extend_to(in.dose().grid(), file);  // around the target there is void
  return in;
}

}  // namespace vam::score_tool
