// SPDX-License-Identifier: GPL-3.0-or-later
// vam-slice --compensate: the deviations of prints, taken off the design before it is placed.
#include "base/compute/memory.hpp"
#include "base/error.hpp"
#include "base/log/log.hpp"
#include "base/text/printable.hpp"
#include "base/text/text.hpp"
#include "io/vdb/vdb.hpp"
#include "model/grid_place.hpp"
#include "model/grid_size.hpp"
#include "solid/voxel/compensation.hpp"
#include "vam-slice/part.hpp"

namespace vam::slice_tool {

namespace {

double rms_of(const io::SparseVolume& volume, const std::string& path) {
  const auto found = volume.metadata.find("vam:rms_mm");
  if (found == volume.metadata.end()) {
    throw Error{Fault::data, path + ": has no RMS deviation (vam:rms_mm); give volumes of vam-sdf --volume"};
  }
  if (const auto rms_mm = parse_number(found->second)) return *rms_mm;
  throw Error{Fault::data,
              path + ": vam:rms_mm is " + excerpt(found->second) + ", not a number; write the volume anew"};
}

}  // namespace

model::TriangleSoup corrected(model::TriangleSoup mesh, const Options& options, Correction& correction) {
  if (options.compensate.empty()) return mesh;
  std::vector<model::Volume> rounds;
  for (const std::string& path : options.compensate) {
    const io::SparseVolume sparse = io::read_volume(path, "sdf");
    require_memory(sizeof(float) * static_cast<double>(sparse.grid().size()),
                   path + ": " + model::size_text(sparse.grid()), "give vam-sdf a larger --volume-voxel");
    correction.rms_mm.push_back(rms_of(sparse, path));
    rounds.push_back(io::dense_volume(sparse));
  }
  // Surfaces of sharp steps lie within a tenth of a voxel; their RMS is known to half of that.
  const model::Grid grid = rounds.front().grid;
  constexpr double uncertainty = 0.05;  // voxels
  correction.applied = solid::rounds_to_apply(correction.rms_mm, uncertainty * grid.voxel_mm);
  if (correction.applied < rounds.size()) {
    warn("compensation has settled: the print after " + std::to_string(correction.applied) +
         " corrections was the best, RMS " + format_number(correction.rms_mm[correction.applied], 4) +
         " mm; the later ones are not applied");
    rounds.resize(correction.applied);
  }
  if (!model::same_voxels(solid::deviation_grid(mesh, grid.voxel_mm), grid)) {
    throw Error{Fault::data, options.compensate.front() + ": is the deviation from another design than " +
                                 options.input + "; give vam-sdf the same mesh"};
  }
  return solid::compensated(mesh, rounds, options.damping);
}

}  // namespace vam::slice_tool
