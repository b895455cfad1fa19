// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/vdb/private/leaf_store.hpp"

#include <cstdint>

#include "base/compute/slab.hpp"
#include "base/index.hpp"

namespace vam::io {

namespace {

constexpr std::size_t leaf_bytes = sizeof(LeafStore::Values);

std::uint64_t offset_of(openvdb::Index32 place) { return (std::uint64_t{place} - 1) * leaf_bytes; }

constexpr int side = LeafStore::Leaf::DIM;
constexpr std::ptrdiff_t column = side;          // values from one y to the next
constexpr std::ptrdiff_t layer = side * column;  // and from one x

/// Of a leaf, where z is fastest and one step along x is 64 values, those of a y: a row of x at every z.
template <class Value>
std::array<Value*, side> rows_at(Value* first, std::ptrdiff_t slice) {
  std::array<Value*, side> rows{};
  for (int z = 0; z < side; ++z) rows[z] = first + z * slice;
  return rows;
}

}  // namespace

void gather_leaf(const float* first, std::ptrdiff_t row, std::ptrdiff_t slice, float* values) {
  for (int y = 0; y < side; ++y) side_by_side(rows_at(first + y * row, slice), side, values + y * column, layer, side);
}

void scatter_leaf(const float* values, float* first, std::ptrdiff_t row, std::ptrdiff_t slice) {
  for (int y = 0; y < side; ++y) one_by_one(values + y * column, layer, side, rows_at(first + y * row, slice));
}

void LeafStore::show(const float* dense, const openvdb::Coord& size) {
  dense_ = dense;
  size_ = size;
}

const float* LeafStore::shown(const openvdb::Coord& origin, Values& room) const {
  const openvdb::Coord last = openvdb::Coord::minComponent(size_ - origin, openvdb::Coord(side));
  if (last == openvdb::Coord(side)) {
    const std::ptrdiff_t slice = std::ptrdiff_t{size_.x()} * size_.y();
    gather_leaf(dense_ + origin.z() * slice + std::ptrdiff_t{origin.y()} * size_.x() + origin.x(), size_.x(), slice,
                room.data());
    return room.data();
  }
  room.fill(0);
  for (int z = 0; z < last.z(); ++z) {
    for (int y = 0; y < last.y(); ++y) {
      const std::size_t row = flat_index(origin.z() + z, size_.y(), origin.y() + y);
      const float* from = dense_ + flat_index(row, size_.x(), origin.x());
      float* to = room.data() + (y << 3) + z;
      for (int x = 0; x < last.x(); ++x) to[x << 6] = from[x];
    }
  }
  return room.data();
}

const float* LeafStore::values(const Leaf& leaf, Values& room) const {
  if (shows()) return shown(leaf.origin(), room);
  if (leaf.transientData() == 0) return leaf.buffer().data();
  file_->read(offset_of(leaf.transientData()), room.data(), leaf_bytes);
  return room.data();
}

void LeafStore::add(Leaf& leaf, const Leaf* old) {
  if (shows()) return;
  if (old != nullptr) remove(*old);
  if (in_memory_ < most_in_memory) {
    ++in_memory_;
    leaf.setTransientData(0);
    return;
  }
  if (file_ == nullptr) file_ = std::make_unique<ScratchFile>();
  openvdb::Index32 place = places_ + 1;
  if (free_.empty()) {
    ++places_;
  } else {
    place = free_.back();
    free_.pop_back();
  }
  file_->write(offset_of(place), leaf.buffer().data(), leaf_bytes);
  leaf.setTransientData(place);
  Leaf::Buffer gone(openvdb::PartialCreate(), 0.0F);
  leaf.swap(gone);
}

void LeafStore::remove(const Leaf& leaf) {
  if (shows()) return;
  if (leaf.transientData() == 0) {
    --in_memory_;
  } else {
    free_.push_back(leaf.transientData());
  }
}

}  // namespace vam::io
