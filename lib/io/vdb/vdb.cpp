// SPDX-License-Identifier: GPL-3.0-or-later
// Dense slices in and out of an OpenVDB tree, leaf by leaf (8 x 8 x 8 voxels). A leaf is built aside, in parallel, and
// inserted into the tree by one thread; going through accessors voxel by voxel takes about 20 times as long.
#include "io/vdb/vdb.hpp"

#include <openvdb/tools/Prune.h>

#include <algorithm>
#include <bit>
#include <cstdint>
#include <optional>
#include <utility>

#include "base/compute/parallel.hpp"
#include "base/error.hpp"
#include "base/index.hpp"
#include "base/text/printable.hpp"
#include "io/stream/finite.hpp"
#include "io/stream/stream.hpp"
#include "io/vdb/private/leaf_store.hpp"
#include "model/grid_place.hpp"
#include "model/grid_size.hpp"

namespace vam::io {

namespace {

using openvdb::Coord;
using openvdb::CoordBBox;
using Tree = openvdb::FloatTree;
using Leaf = Tree::LeafNodeType;

constexpr int edge = Leaf::DIM;
constexpr int shift = Leaf::LOG2DIM;
static_assert(edge == 8, "the loops over a leaf and vam-formats(7) say 8");

// Slices k0 .. k0 + count - 1 as a box of voxels, and the leaf-sized blocks that it touches.
struct LeafSlab {
  CoordBBox box;
  Coord first_block;
  Coord blocks;  // along each axis
  [[nodiscard]] int rows() const { return blocks.y() * blocks.z(); }
  // In the dense slices: floats from one row or slice to the next, and before a voxel.
  [[nodiscard]] std::ptrdiff_t row() const { return box.dim().x(); }
  [[nodiscard]] std::ptrdiff_t slice() const { return row() * box.dim().y(); }
  [[nodiscard]] std::ptrdiff_t place(const Coord& at) const {
    const Coord from = at - box.min();
    return from.z() * slice() + from.y() * row() + from.x();
  }
  [[nodiscard]] Coord origin(int row, int i) const {
    const Coord block = first_block.offsetBy(i, row % blocks.y(), row / blocks.y());
    return {block.x() * edge, block.y() * edge, block.z() * edge};
  }
  // The part of the block at `at` that lies in the slab.
  [[nodiscard]] CoordBBox part(const Coord& at) const {
    CoordBBox inside = CoordBBox::createCube(at, edge);
    inside.intersect(box);
    return inside;
  }
};

LeafSlab slab_of(const model::Grid& grid, const Coord& first, int k0, int count) {
  if (k0 < 0 || count < 0 || count > grid.nz - k0) {
    throw Error{Fault::bug, "slices " + std::to_string(k0) + " to " + std::to_string(k0 + count) + " of " +
                                std::to_string(grid.nz) + " requested"};
  }
  LeafSlab slab;
  slab.box = {first.offsetBy(0, 0, k0), first.offsetBy(grid.nx - 1, grid.ny - 1, k0 + count - 1)};
  slab.first_block = slab.box.min() >> shift;
  slab.blocks = (slab.box.max() >> shift) - slab.first_block + Coord(1);
  return slab;
}

// Calls row(x0, y, z, n, at): n voxels along x from (x0, y, z), the first of which is dense[at].
template <class Row>
void for_rows(const CoordBBox& part, const CoordBBox& slab, const Row& row) {
  const auto width = static_cast<std::size_t>(slab.dim().x());
  const auto height = static_cast<std::size_t>(slab.dim().y());
  for (int z = part.min().z(); z <= part.max().z(); ++z) {
    for (int y = part.min().y(); y <= part.max().y(); ++y) {
      const std::size_t at = (static_cast<std::size_t>(z - slab.min().z()) * height + y - slab.min().y()) * width +
                             static_cast<std::size_t>(part.min().x() - slab.min().x());
      row(part.min().x(), y, z, part.dim().x(), at);
    }
  }
}

// Place in a leaf's buffer, where z is the fastest axis; one step along x is 64 values.
int in_leaf(int x, int y, int z) { return ((x & 7) << 6) + ((y & 7) << 3) + (z & 7); }

// What a block is to become: a leaf of its own, or one value.
struct LeafBlock {
  std::unique_ptr<Leaf> leaf;
  float value = 0;
};

bool is_one_value(const float* values) {
  const auto first = std::bit_cast<std::uint32_t>(values[0]);
  std::uint32_t difference = 0;  // gathered without an early exit: vector code
  for (openvdb::Index i = 1; i < Leaf::SIZE; ++i) difference |= std::bit_cast<std::uint32_t>(values[i]) ^ first;
  return difference == 0;
}

// Active is what differs from the background; 64 voxels a word, in the order of the buffer.
Leaf::NodeMaskType active_mask(const float* values, float background) {
  Leaf::NodeMaskType mask;
  for (openvdb::Index word = 0; word < Leaf::SIZE / 64; ++word) {
    openvdb::Index64 bits = 0;
    for (openvdb::Index i = 0; i < 64; ++i) {
      bits |= static_cast<openvdb::Index64>(values[word * 64 + i] != background) << i;
    }
    mask.getWord<openvdb::Index64>(word) = bits;
  }
  return mask;
}

// The value of all voxels of a whole block, which most have: they need no order of a leaf (gyroid: 8 % of vam-slice).
std::optional<float> shared_value(const CoordBBox& part, const CoordBBox& slab, const float* in) {
  if (part.volume() < Leaf::SIZE) return std::nullopt;
  std::optional<std::uint32_t> first;
  std::uint32_t difference = 0;
  for_rows(part, slab, [&](int, int, int, int, std::size_t from) {
    if (!first) first = std::bit_cast<std::uint32_t>(in[from]);
    for (std::size_t i = 0; i < edge; ++i) difference |= std::bit_cast<std::uint32_t>(in[from + i]) ^ *first;
  });
  return difference == 0 ? std::optional(std::bit_cast<float>(*first)) : std::nullopt;
}

LeafBlock block_at(const Coord& at, const LeafSlab& slab, const float* in, const SparseVolume::State& state,
                   ConstAccessor& accessor) {
  const float background = state.sparse->background();
  const CoordBBox part = slab.part(at);
  if (const auto value = shared_value(part, slab.box, in); value && all_finite(&*value, 1)) return {nullptr, *value};
  LeafStore::Values room;
  float values[Leaf::SIZE] = {};
  if (part.volume() == Leaf::SIZE) {
    gather_leaf(in + slab.place(at), slab.row(), slab.slice(), values);
  } else {
    const Leaf* old = accessor.probeConstLeaf(at);
    if (old != nullptr) {
      std::copy_n(state.leaves->values(*old, room), Leaf::SIZE, values);
    } else {
      std::fill_n(values, Leaf::SIZE, accessor.getValue(at));
    }
    for_rows(part, slab.box, [&](int x, int y, int z, int n, std::size_t from) {
      float* to = values + in_leaf(x, y, z);
      for (int i = 0; i < n; ++i) to[i << 6] = in[from + i];
    });
  }
  LeafBlock block;
  block.value = values[0];
  if (!all_finite(values, Leaf::SIZE)) {
    throw Error{Fault::bug, "a voxel of " + std::to_string(at.x()) + " " + std::to_string(at.y()) + " " +
                                std::to_string(at.z()) + " and on is not a finite number"};
  }
  if (is_one_value(values)) return block;
  block.leaf = std::make_unique<Leaf>(openvdb::PartialCreate(), at, background, false);
  if (!state.leaves->shows()) {
    block.leaf->allocate();
    std::copy_n(values, Leaf::SIZE, block.leaf->buffer().data());
  }
  block.leaf->setValueMask(active_mask(values, background));
  return block;
}

void hang_in(LeafBlock& block, const Coord& at, const SparseVolume::State& state, Accessor& accessor) {
  const float background = state.sparse->background();
  const Leaf* old = accessor.probeConstLeaf(at);
  if (block.leaf) {
    state.leaves->add(*block.leaf, old);
    accessor.addLeaf(block.leaf.release());
    return;
  }
  if (old != nullptr) state.leaves->remove(*old);
  if (block.value != background) {
    accessor.addTile(1, at, block.value, true);
  } else if (old != nullptr || accessor.getValue(at) != background) {
    accessor.addTile(1, at, background, false);
  }
}

}  // namespace

SparseVolume::SparseVolume(std::string name, const model::Grid& grid, float background)
    : state_(std::make_unique<State>()) {
  if (grid.nx < 1 || grid.ny < 1 || grid.nz < 1 || !(grid.voxel_mm > 0)) {
    throw Error{Fault::bug, "a volume of " + std::to_string(grid.nx) + " x " + std::to_string(grid.ny) + " x " +
                                std::to_string(grid.nz) + " voxels"};
  }
  state_->name = std::move(name);
  state_->grid = grid;
  state_->sparse = openvdb::FloatGrid::create(background);
  // From the unit map, as a transform made of the numbers at once takes the voxel as a square root of its square.
  auto transform = openvdb::math::Transform::createLinearTransform();
  transform->preScale(grid.voxel_mm);
  transform->postTranslate({grid.origin_mm[0], grid.origin_mm[1], grid.origin_mm[2]});
  state_->sparse->setTransform(transform);
}

SparseVolume::SparseVolume(SparseVolume&&) noexcept = default;
SparseVolume& SparseVolume::operator=(SparseVolume&&) noexcept = default;
SparseVolume::~SparseVolume() = default;

const std::string& SparseVolume::name() const { return state_->name; }
const model::Grid& SparseVolume::grid() const { return state_->grid; }
float SparseVolume::background() const { return state_->sparse->background(); }

void SparseVolume::extend_to(const model::Grid& grid, const std::string& file) {
  const auto place = model::place_in(grid, state_->grid);
  if (!place) {
    throw Error{Fault::data, input_name(file) + ": the grid " + excerpt(state_->name) + " has " +
                                 model::place_text(state_->grid) + ", which are not among the " +
                                 model::place_text(grid) + " it is compared with; make both from the same target"};
  }
  state_->first -= Coord((*place)[0], (*place)[1], (*place)[2]);
  state_->grid = grid;
}

void SparseVolume::read_slices(int k0, int count, float* out) const {
  const LeafSlab slab = slab_of(state_->grid, state_->first, k0, count);
  const Tree& tree = state_->sparse->constTree();
  parallel_for(slab.rows(), [&](int row) {
    ConstAccessor accessor(tree);
    LeafStore::Values room;
    for (int i = 0; i < slab.blocks.x(); ++i) {
      const Coord at = slab.origin(row, i);
      const Leaf* leaf = accessor.probeConstLeaf(at);
      const float* values = leaf != nullptr ? state_->leaves->values(*leaf, room) : nullptr;
      const float tile = leaf != nullptr ? 0.0F : accessor.getValue(at);
      const CoordBBox part = slab.part(at);
      if (values != nullptr && part.volume() == Leaf::SIZE) {
        scatter_leaf(values, out + slab.place(at), slab.row(), slab.slice());
        continue;
      }
      for_rows(part, slab.box, [&](int x, int y, int z, int n, std::size_t to) {
        if (values == nullptr) {
          std::fill_n(out + to, n, tile);
          return;
        }
        const float* from = values + in_leaf(x, y, z);
        for (int step = 0; step < n; ++step) out[to + step] = from[step << 6];
      });
    }
  });
}

void for_blocks(const SparseVolume& volume, const std::function<void(const VoxelBlock&)>& take) {
  const SparseVolume::State& state = volume.state();
  auto tile = state.sparse->constTree().cbeginValueAll();
  tile.setMaxDepth(Tree::DEPTH - 2);  // above the leaves
  for (; tile; ++tile) {
    const CoordBBox box = tile.getBoundingBox();
    const Coord at = box.min() - state.first;
    take({at.x(), at.y(), at.z(), box.dim().x(), nullptr, *tile});
  }
  LeafStore::Values room;
  for (auto leaf = state.sparse->constTree().cbeginLeaf(); leaf; ++leaf) {
    const Coord at = leaf->origin() - state.first;
    take({at.x(), at.y(), at.z(), edge, state.leaves->values(*leaf, room)});
  }
}

model::Volume dense_volume(const SparseVolume& sparse) {
  model::Volume volume{sparse.grid(), std::vector<float>(sparse.grid().size())};
  sparse.read_slices(0, volume.grid.nz, volume.values.data());
  return volume;
}

void SparseVolume::write_slices(int k0, int count, const float* in) {
  const LeafSlab slab = slab_of(state_->grid, state_->first, k0, count);
  Tree& tree = state_->sparse->tree();
  std::vector<std::vector<LeafBlock>> rows(slab.rows());
  parallel_for(slab.rows(), [&](int row) {
    ConstAccessor accessor(tree);
    for (int i = 0; i < slab.blocks.x(); ++i) {
      rows[row].push_back(block_at(slab.origin(row, i), slab, in, *state_, accessor));
    }
  });
  Accessor accessor(tree);
  for (int row = 0; row < slab.rows(); ++row) {
    for (int i = 0; i < slab.blocks.x(); ++i) {
      LeafBlock& block = rows[row][i];
      hang_in(block, slab.origin(row, i), *state_, accessor);
    }
  }
}

void SparseVolume::show(const float* in) {
  state_->leaves->show(in, {state_->grid.nx, state_->grid.ny, state_->grid.nz});
  write_slices(0, state_->grid.nz, in);
}

void SparseVolume::prune() {
  Tree& tree = state_->sparse->tree();
  if (state_->leaves->spilt()) {
    openvdb::tools::pruneTiles(tree);  // leaves of one value were never hung in
  } else {
    openvdb::tools::prune(tree);
  }
}

}  // namespace vam::io
