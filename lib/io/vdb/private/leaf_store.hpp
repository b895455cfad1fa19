// SPDX-License-Identifier: GPL-3.0-or-later
// Private to the VDB files: where the values of a tree's leaves are, some in memory and the others in a scratch file.
#pragma once

#include <openvdb/openvdb.h>

#include <array>
#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "base/scratch_file.hpp"
#include "io/vdb/vdb.hpp"

namespace vam::io {

/// Ways into a tree that remember the nodes above its leaves alone: OpenVDB's usual ones touch the values of every leaf
/// that they pass, and give an emptied one its memory again.
using Accessor = openvdb::tree::ValueAccessor2<openvdb::FloatTree, false, 1, 2>;
using ConstAccessor = openvdb::tree::ValueAccessor2<const openvdb::FloatTree, false, 1, 2>;

/// The 512 values of a leaf whose voxels are all in a dense volume, x fastest, from `first` on, `row` and `slice`
/// floats apart; and the other way round.
void gather_leaf(const float* first, std::ptrdiff_t row, std::ptrdiff_t slice, float* values);
void scatter_leaf(const float* values, float* first, std::ptrdiff_t row, std::ptrdiff_t slice);

/// The first leaves of a tree keep their values, 32 MiB; those of all others go into the file, and OpenVDB has the
/// leaf without them: values() finds them again, nothing else may read them. A leaf's transient data is its place in
/// the file, from 1 on.
class LeafStore {
 public:
  using Leaf = openvdb::FloatTree::LeafNodeType;
  using Values = std::array<float, Leaf::SIZE>;
  static constexpr std::size_t most_in_memory = 16384;

  /// 512 values, in the leaf or in `room`. Any threads at once.
  [[nodiscard]] const float* values(const Leaf& leaf, Values& room) const;

  /// A leaf with its values comes into the tree, instead of `old` if there was one there. Throws Fault::no_output and
  /// io as ScratchFile does.
  void add(Leaf& leaf, const Leaf* old);
  /// A leaf leaves the tree.
  void remove(const Leaf& leaf);

  /// Leaves come without values from here on: theirs are the voxels of `dense`, x fastest, from (0, 0, 0) on.
  void show(const float* dense, const openvdb::Coord& size);
  [[nodiscard]] bool shows() const { return dense_ != nullptr; }

  /// Whether leaves without values are in the tree.
  [[nodiscard]] bool spilt() const { return file_ != nullptr || shows(); }

 private:
  [[nodiscard]] const float* shown(const openvdb::Coord& origin, Values& room) const;

  const float* dense_ = nullptr;
  openvdb::Coord size_;  // of it
  std::size_t in_memory_ = 0;
  openvdb::Index32 places_ = 0;  // of the file
  std::vector<openvdb::Index32> free_;
  std::unique_ptr<ScratchFile> file_;
};

struct SparseVolume::State {
  std::string name;
  model::Grid grid;
  openvdb::FloatGrid::Ptr sparse;
  std::shared_ptr<LeafStore> leaves = std::make_shared<LeafStore>();  // of the tree, which grids may share
  openvdb::Coord first;  // index of voxel (0, 0, 0) in `sparse`; not 0 in files of other programs
};

}  // namespace vam::io
