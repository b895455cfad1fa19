// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/hdf5/private/hdf5_images.hpp"

#include <algorithm>
#include <utility>

#include "base/error.hpp"
#include "io/hdf5/hdf5_array.hpp"
#include "io/hdf5/private/hdf5_tree.hpp"

namespace vam::io::hdf5 {

namespace {

constexpr std::uint64_t enough = std::uint64_t{1} << 26;  // bytes read together where more would gain nothing

}  // namespace

std::array<std::uint64_t, 3> three_axes(const std::vector<std::uint64_t>& shape, const std::string& subject) {
  constexpr std::uint64_t most_side = 1 << 16;
  const std::size_t rank = shape.size();
  if (rank != 2 && rank != 3) {
    throw Error{Fault::data, subject + " has " + std::to_string(rank) + " dimensions" +
                                 (rank == 0 ? "" : " (" + shape_text(shape) + ")") + "; 2 or 3 are read"};
  }
  if (std::any_of(shape.begin(), shape.end(), [](std::uint64_t side) { return side == 0 || side > most_side; })) {
    throw Error{Fault::data, subject + " has " + shape_text(shape) + " values; 1 to 65536 along an axis are read"};
  }
  return {rank == 2 ? 1 : shape[0], shape[rank - 2], shape[rank - 1]};
}

Images::Images(hid_t dataset, Order order, std::uint64_t memory, std::string subject)
    : dataset_(dataset), order_(std::move(order)), subject_(std::move(subject)) {
  const std::vector<std::uint64_t> shape = describe(dataset_, "").shape;
  rank_ = shape.size();
  shape_ = three_axes(shape, subject_);
  size_ = {shape_[order_.axes[0]], order_.rows.size(), shape_[order_.axes[2]]};
  plan_depth(memory);
}

// A chunk is unpacked once where as many images as it is deep are read together.
void Images::plan_depth(std::uint64_t memory) {
  const Handle properties(api().H5Dget_create_plist(dataset_));
  std::array<hsize_t, 3> chunk{1, 1, 1};
  if (api().H5Pget_layout(properties.id()) == H5D_CHUNKED) {
    api().H5Pget_chunk(properties.id(), static_cast<int>(rank_), chunk.data() + (3 - rank_));
  }
  const std::uint64_t image_bytes = shape_[order_.axes[1]] * shape_[order_.axes[2]] * sizeof(float);
  const std::uint64_t deep = std::max<std::uint64_t>(chunk[order_.axes[0]], 1);
  const std::uint64_t most = memory / image_bytes;
  const bool as_stored = order_.axes[0] == 0;
  const std::uint64_t wanted = as_stored ? std::max(enough / image_bytes, deep) : most;
  depth_ = std::clamp<std::uint64_t>(std::min(wanted, most), 1, size_[0]);
  if (depth_ > deep) depth_ -= depth_ % deep;
}

void Images::read_block() {
  const Api& h5 = api();
  held_ = std::min(depth_, size_[0] - done_);
  first_ = order_.backwards ? place() + 1 - held_ : place();
  std::array<hsize_t, 3> start{};
  std::array<hsize_t, 3> count{shape_[0], shape_[1], shape_[2]};
  start[order_.axes[0]] = first_;
  count[order_.axes[0]] = held_;
  stride_ = {count[1] * count[2], count[2], 1};
  block_.resize(count[0] * count[1] * count[2]);
  const std::size_t unused = 3 - rank_;
  const Handle from(h5.H5Dget_space(dataset_));
  const Handle to(h5.H5Screate_simple(static_cast<int>(rank_), count.data() + unused, nullptr));
  const herr_t chosen =
      h5.H5Sselect_hyperslab(from.id(), H5S_SELECT_SET, start.data() + unused, nullptr, count.data() + unused, nullptr);
  if (chosen < 0 || h5.H5Dread(dataset_, *h5.native_float, to.id(), from.id(), H5P_DEFAULT, block_.data()) < 0) {
    throw Error{Fault::data, subject_ + " is truncated or damaged" + cause()};
  }
}

bool Images::next(std::vector<float>& image) {
  if (done_ == size_[0]) return false;
  if (place() < first_ || place() >= first_ + held_) read_block();
  const float* from = block_.data() + (place() - first_) * stride_[order_.axes[0]];
  const std::size_t step = stride_[order_.axes[2]];
  image.resize(size_[1] * size_[2]);
  float* to = image.data();
  for (const std::size_t row : order_.rows) {
    const float* value = from + row * stride_[order_.axes[1]];
    for (std::size_t c = 0; c < size_[2]; ++c) *to++ = value[c * step];
  }
  ++done_;
  return true;
}

}  // namespace vam::io::hdf5
