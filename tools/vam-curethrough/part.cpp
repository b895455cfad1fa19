// SPDX-License-Identifier: GPL-3.0-or-later
#include "vam-curethrough/part.hpp"

#include <algorithm>
#include <cmath>

#include "base/log/log.hpp"
#include "base/text/text.hpp"
#include "io/stream/stream.hpp"
#include "io/vdb/gate.hpp"
#include "model/metadata.hpp"

namespace vam::curethrough {

namespace {

// Reverses the order of `count` slices of `size` values.
void reverse_slices(float* values, int count, std::size_t size) {
  for (int low = 0, high = count - 1; low < high; ++low, --high) {
    std::swap_ranges(values + static_cast<std::size_t>(low) * size, values + static_cast<std::size_t>(low + 1) * size,
                     values + static_cast<std::size_t>(high) * size);
  }
}

// The box of a block that lies in the volume.
struct Box {
  int x0, x1, y0, y1, z0, z1;  // first and one beyond the last
  Box(const io::VoxelBlock& block, const model::Grid& grid)
      : x0(std::max(0, block.i)),
        x1(std::min(grid.nx, block.i + block.edge)),
        y0(std::max(0, block.j)),
        y1(std::min(grid.ny, block.j + block.edge)),
        z0(std::max(0, block.k)),
        z1(std::min(grid.nz, block.k + block.edge)) {}
};

std::uint64_t reversed(std::uint64_t bits, int count) {
  std::uint64_t turned = 0;
  for (int b = 0; b < count; ++b) turned |= (bits >> b & 1U) << (count - 1 - b);
  return turned;
}

}  // namespace

void add_part(cli::App& app, PartOptions& options, const std::vector<std::string>& not_for) {
  app.choice(
         "--platform", options.platform, {"bottom", "top"},
         "End of the volume that adheres to the platform and is printed first; the light enters from the other end.")
      .not_for(not_for);
  app.option("--min-coverage", "FRACTION", options.threshold, {0, 1, true}, "Minimum coverage of a voxel of the part.")
      .not_for(not_for);
}

PartFile::PartFile(const PartOptions& options, resin::ExposureMode exposure)
    : options_(options), name_(io::input_name(options.path)), least_(static_cast<float>(options.threshold)) {
  const io::SparseVolume volume = io::read_volume(options.path, "target");
  io::check_values(options.path, volume);
  grid_ = volume.grid();
  history_ = volume.history;
  columns_.emplace(grid_.nx, grid_.ny, grid_.nz, exposure);
  io::for_blocks(volume, [this](const io::VoxelBlock& block) { take(block); });
  const double factor = model::stretch_z(volume.metadata);
  if (std::fabs(factor - 1) > 1e-6) {
    warn(name_ + ": stretched along z by " + format_number(factor) +
         " for a vial, which vam-curethrough does not model; slice with --stretch-z 1");
  }
}

void PartFile::take(const io::VoxelBlock& block) {
  const Box box(block, grid());
  const int count = box.z1 - box.z0;
  const int first = upside_down() ? grid().nz - box.z1 : box.z0;
  if (block.values == nullptr && block.value < least_) return;
  for (int y = box.y0; y < box.y1 && count > 0; ++y) {
    for (int x = box.x0; x < box.x1; ++x) {
      if (block.values == nullptr) {
        columns_->fill(pixel(x, y), first, count, true);
        continue;
      }
      const int corner = ((x - block.i) * 8 + (y - block.j)) * 8 + (box.z0 - block.k);
      const float* column = block.values + corner;
      std::uint64_t bits = 0;
      for (int b = 0; b < count; ++b) bits |= static_cast<std::uint64_t>(column[b] >= least_) << b;
      columns_->put(pixel(x, y), first, count, upside_down() ? reversed(bits, count) : bits);
    }
  }
}

model::Grid PartFile::extended(int slices) const {
  model::Grid grid = grid_;
  if (upside_down()) grid.origin_mm[2] -= (slices - grid.nz) * grid.voxel_mm;
  grid.nz = slices;
  return grid;
}

void PartFile::write(io::SparseVolume& volume, int first, int count, std::vector<float>& slices) const {
  if (!upside_down()) return volume.write_slices(first, count, slices.data());
  reverse_slices(slices.data(), count, grid().slice_size());
  volume.write_slices(volume.grid().nz - first - count, count, slices.data());
}

}  // namespace vam::curethrough
