// SPDX-License-Identifier: GPL-3.0-or-later
// Volumes as OpenVDB grids in mm, sparse in memory; dense only slab by slab.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "model/dose/stray_cure.hpp"
#include "model/grid.hpp"

namespace vam::io {

class StackReader;

/// One float grid. `name` is target, insert, weight, dose, scatter or sdf. Slices are dense row-major images (x
/// fastest, then y), one after the other.
class SparseVolume {
 public:
  SparseVolume(std::string name, const model::Grid& grid, float background = 0.0F);
  SparseVolume(SparseVolume&&) noexcept;
  SparseVolume& operator=(SparseVolume&&) noexcept;
  ~SparseVolume();

  [[nodiscard]] const std::string& name() const;
  [[nodiscard]] const model::Grid& grid() const;
  [[nodiscard]] float background() const;

  /// Copies slices k0 .. k0 + count - 1 out. Several threads may read at once.
  void read_slices(int k0, int count, float* out) const;
  /// Copies slices in; background values are not stored. One thread at a time; whole multiples of 8 slices from a
  /// multiple of 8 are fastest.
  void write_slices(int k0, int count, const float* in);
  /// All slices of a volume that holds nothing yet, background 0, without a copy: `in` stays as it is while this lives.
  void show(const float* in);
  /// Takes a larger grid of the same voxels, with the background around; nothing is copied. Throws Fault::data where
  /// the grid does not hold this one, of that file, or its voxels lie elsewhere.
  void extend_to(const model::Grid& grid, const std::string& file);
  /// Collapses constant blocks to tiles; done by write_volumes.
  void prune();

  std::vector<std::string> history;             // vam:history
  std::string units = "relative";               // vam:units
  std::map<std::string, std::string> metadata;  // other string metadata, vam:printer and vam:stretch_z among them
  bool level_set = false;                       // distances, as the file says

  struct State;  // holds the openvdb grid
  [[nodiscard]] State& state() const { return *state_; }

 private:
  std::unique_ptr<State> state_;
};

/// All of its voxels.
[[nodiscard]] model::Volume dense_volume(const SparseVolume& sparse);

/// Distance from the axis x = y = 0 to the farthest centre of a voxel whose value is above that, in mm; -1 where none
/// is.
[[nodiscard]] double farthest_mm(const SparseVolume& volume, float above);

/// All float grids of a file or of the archives on stdin ("-"). Throws Error: no_input, data (not VDB, truncated, not
/// float, non-uniform or rotated transform, NaN values, other than what was sealed), io.
std::vector<SparseVolume> read_volumes(const std::string& path);

/// Of the grids of a file the one of that name; the only one when name is empty. Throws Fault::data naming the grids
/// that are there.
[[nodiscard]] SparseVolume& choose_volume(std::vector<SparseVolume>& volumes, const std::string& name,
                                          const std::string& path);
SparseVolume read_volume(const std::string& path, const std::string& name);

/// What a volume is, before its voxels.
struct VolumeFacts {
  std::string name;
  model::Grid grid;
  float background = 0;
  std::vector<std::string> history;
  std::string units = "relative";
  std::map<std::string, std::string> metadata;
  bool level_set = false;  // distances, as the file says
  std::string seal;        // 16 digits; empty: not sealed
};

/// A cube of voxels as OpenVDB stores them. Its corner is voxel (i, j, k); parts of it may lie beyond the volume's box.
struct VoxelBlock {
  int i = 0;
  int j = 0;
  int k = 0;
  int edge = 8;                   // voxels a side; more only where all have one value
  const float* values = nullptr;  // 512 values, x slowest and z fastest; null: every voxel is `value`
  float value = 0;
};

/// Shows the blocks of a volume, in no useful order; voxels in no block have the background's value.
void for_blocks(const SparseVolume& volume, const std::function<void(const VoxelBlock&)>& take);

/// What the grids of floats are, and whether they are what was written; of a file `fast` looks at their heads alone,
/// and leaves grid and background out. Throws what read_volumes throws.
[[nodiscard]] std::vector<VolumeFacts> check_volumes(const std::string& path, bool fast);

/// Writes one archive, with seals: a reader finds where it differs. "-" is stdout. A file appears under its final
/// name only when complete.
void write_volumes(const std::string& path, std::vector<SparseVolume>& volumes);
void write_volume(const std::string& path, SparseVolume& volume);

/// The smallest box of the volume's grid that holds all voxels whose value is above that.
[[nodiscard]] model::VoxelBox covered_box(const SparseVolume& volume, float above);

/// Writes the dense box of a volume as NRRD, raw floats behind a text header: x fastest, right-handed, mm. "-" is
/// stdout. Constant memory beside the volume. Throws Error: no_output, io.
void write_nrrd(const std::string& path, const SparseVolume& volume);

/// Writes a whole stack front to back, columns fastest: (column, angle, slice) of sinograms, (column, row, frame) of
/// frames, each axis with its spacing and unit. Throws what reading throws, and no_output, io.
void write_nrrd(const std::string& path, StackReader& stack);

}  // namespace vam::io
