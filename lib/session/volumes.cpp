// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/volumes.hpp"

#include <utility>

#include "base/index.hpp"
#include "base/log/log.hpp"
#include "base/text/printable.hpp"
#include "io/stream/stream.hpp"
#include "model/grid_place.hpp"
#include "model/metadata.hpp"

namespace vam::session {

std::vector<io::SparseVolume> read_grids(const std::string& path, std::optional<io::TargetKind> kind) {
  std::vector<io::SparseVolume> grids = io::read_volumes(path);
  if (kind) io::check_values(path, grids, *kind);
  return grids;
}

std::vector<io::SparseVolume> read_like(const std::string& path) {
  std::vector<io::SparseVolume> grids = io::read_volumes(path);
  const io::SparseVolume* target = find_grid(grids, "target");
  const bool states_unit = target != nullptr && target->units != "relative";
  io::check_values(path, grids, states_unit ? io::TargetKind::grey : io::TargetKind::coverage);
  return grids;
}

io::SparseVolume& target_or_first(std::vector<io::SparseVolume>& grids) {
  io::SparseVolume* target = find_grid(grids, "target");
  return target != nullptr ? *target : grids.front();
}

io::SparseVolume& require_grid(std::vector<io::SparseVolume>& grids, const std::string& name, const std::string& file,
                               const std::string& remedy) {
  if (io::SparseVolume* found = find_grid(grids, name)) return *found;
  throw Error{Fault::data, file + ": has no grid '" + name + "'; " + remedy};
}

io::SparseVolume taken(std::vector<io::SparseVolume>& grids, io::SparseVolume& grid) {
  io::SparseVolume one = std::move(grid);
  grids.erase(grids.begin() + (&grid - grids.data()));
  return one;
}

io::SparseVolume read_grid(const std::string& path, const std::string& name) {
  std::vector<io::SparseVolume> grids = read_grids(path, io::TargetKind::coverage);
  for (io::SparseVolume& grid : grids) {
    if (grid.name() == name || grids.size() == 1) return std::move(grid);
  }
  throw Error{Fault::data, path + ": has several grids, but none is called '" + name + "'"};
}

model::StretchedVolume read_target(const std::string& path) {
  const io::SparseVolume target = read_grid(path, "target");
  return {io::dense_volume(target), model::stretch_z(target.metadata)};
}

io::SparseVolume read_dose(const std::string& path) {
  io::SparseVolume dose = io::read_volume(path, "dose");
  io::check_values(path, dose);
  if (dose.units == "mJ/cm3") return dose;
  throw Error{Fault::data, path + ": the dose is in units of " + excerpt(dose.units) +
                               ", not mJ/cm3; set resin.critical_dose_mj_cm3 and resin.absorption_per_mm in "
                               "vam-dose"};
}

io::SparseVolume read_scatter(const std::string& path) {
  io::SparseVolume scatter = io::read_volume(path, "scatter");
  if (scatter.units != "mJ/cm3") return scatter;
  throw Error{Fault::data, path + ": its values are a dose in mJ/cm3, not scattering; give a volume of vam-ost"};
}

Companions::Companions(const std::string& path, const std::string& part, std::optional<io::TargetKind> kind)
    : path_(path), part_(part), own_(read_grids(path, kind)) {
  if (!part.empty()) others_ = read_grids(part, kind);
}

io::SparseVolume& Companions::choose(const std::string& name) {
  volume_ = &io::choose_volume(own_, name, path_);
  return *volume_;
}

io::SparseVolume& Companions::target() {
  return require_grid(beside(), "target", io::input_name(file()),
                      part_.empty() ? "give the file of the part by --target" : "vam-slice writes one");
}

io::SparseVolume& Companions::target_around() {
  target().extend_to(volume_->grid(), file());
  return target();
}

const io::SparseVolume* Companions::insert() {
  io::SparseVolume* found = find_grid(beside(), "insert");
  if (found == nullptr || volume_->name() == "insert") return nullptr;
  found->extend_to(volume_->grid(), file());
  return found;
}

void read_around(const io::SparseVolume& volume, const model::Grid& grid, float outside, int k, int count, float* to) {
  const model::Grid& own = volume.grid();
  const auto place = model::place_in(grid, own);
  if (!place) throw differs_from_target(volume, "target");
  const auto& [left, front, low] = *place;
  std::fill_n(to, product(count, grid.slice_size()), outside);
  std::vector<float> slice(own.slice_size());
  for (int n = 0; n < count; ++n, to += grid.slice_size()) {
    const int from = k + n - low;
    if (from < 0 || from >= own.nz) continue;
    volume.read_slices(from, 1, slice.data());
    float* corner = to + product(front, grid.nx) + left;
    for (int y = 0; y < own.ny; ++y)
      std::copy_n(slice.data() + product(y, own.nx), own.nx, corner + product(y, grid.nx));
  }
}

Error differs_from_target(const io::SparseVolume& volume, const std::string& file) {
  return {Fault::data, file + ": the grid of '" + volume.name() +
                           "' differs from that of the target; make both from the same target"};
}

void warn_of_shadowed_voxels(const std::string& path, std::int64_t voxels) {
  if (voxels <= 0) return;
  warn(io::input_name(path) + ": the insert shadows " + std::to_string(voxels) +
       " voxels of the part from all stage angles; they will not print");
}

}  // namespace vam::session
