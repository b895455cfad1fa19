// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/vdb/gate.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <set>

#include "base/error.hpp"
#include "base/text/printable.hpp"
#include "base/text/text.hpp"
#include "io/stream/stream.hpp"
#include "io/vdb/private/facts.hpp"

namespace vam::io {

namespace {

constexpr float slack = 1e-4F;  // of targets that other programs compute
constexpr double least_mm = 0.1;
constexpr double most_mm = 2000;

// What the values of a grid may be.
struct ValueRange {
  float low;
  float high;
  std::string words;
};

bool is_shape(const std::string& name) { return name == "target" || name == "insert"; }

std::optional<ValueRange> promise_of(const std::string& name, TargetKind target) {
  constexpr float most = 1e9F;
  if (name == "target" && target == TargetKind::grey) {
    return ValueRange{-slack, most, "a grey target is a dose, 0 and more; make it again"};
  }
  if (is_shape(name)) {
    return ValueRange{-slack, 1 + slack,
                      "this is coverage, 0 to 1; make it with vam-slice, or scale it (vam-convert --full-scale)"};
  }
  if (name == "weight" || name == "tolerance" || name == "dose") {
    return ValueRange{0, most, "a " + name + " is 0 and more, below 1e9; make it again"};
  }
  return std::nullopt;
}

[[noreturn]] void refuse(const std::string& path, const std::string& name, const std::string& why) {
  throw Error{Fault::data, input_name(path) + ": grid " + excerpt(name) + " " + why};
}

[[noreturn]] void refuse_voxel(const std::string& path, const std::string& name, const std::array<int, 3>& at,
                               float value, const ValueRange& promise) {
  refuse(path, name,
         "has " + format_number(value) + " in voxel (" + std::to_string(at[0]) + ", " + std::to_string(at[1]) + ", " +
             std::to_string(at[2]) + "); " + promise.words);
}

// The first value of a leaf outside what is promised, as its place; 512 when there is none.
int first_outside(const float* values, const ValueRange& promise) {
  constexpr int count = 512;
  float low = values[0];
  float high = values[0];
  for (int i = 0; i < count; ++i) {  // without an early exit: vector code
    low = std::min(low, values[i]);
    high = std::max(high, values[i]);
  }
  const auto is_outside = [&](float value) { return !(value >= promise.low && value <= promise.high); };
  if (!is_outside(low) && !is_outside(high)) return count;
  return static_cast<int>(std::find_if(values, values + count, is_outside) - values);
}

void require_values(const std::string& path, const std::string& name, const VoxelBlock& block,
                    const ValueRange& promise) {
  if (block.values == nullptr) {
    if (block.value >= promise.low && block.value <= promise.high) return;
    refuse_voxel(path, name, {block.i, block.j, block.k}, block.value, promise);
  }
  const int place = first_outside(block.values, promise);
  if (place == 512) return;
  refuse_voxel(path, name, {block.i + (place >> 6), block.j + (place >> 3 & 7), block.k + (place & 7)},
               block.values[place], promise);
}

}  // namespace

void check_values(const std::string& path, const SparseVolume& volume, TargetKind target) {
  const std::string& name = volume.name();
  const auto promise = promise_of(name, target);
  if (!promise) return;
  if (is_shape(name) && volume.level_set) {
    refuse(
        path, name,
        "is a level set, distances; make coverage of it: vam-sdf or another program makes a mesh, vam-slice slices it");
  }
  if (is_shape(name) && volume.background() != 0) {
    refuse(path, name,
           "has " + format_number(volume.background()) +
               " wherever it stores nothing, solid around the part; its background must be 0");
  }
  const model::Grid& grid = volume.grid();
  const double longest = grid.voxel_mm * std::max({grid.nx, grid.ny, grid.nz});
  if (longest < least_mm || longest > most_mm) {
    refuse(path, name,
           "is " + format_number(longest) + " mm long, from voxels of " + format_number(grid.voxel_mm) +
               " mm; is it in " + (longest < least_mm ? "metres? Scale it by 1000" : "micrometres? Scale it by 0.001"));
  }
  for_blocks(volume, [&](const VoxelBlock& block) { require_values(path, name, block, *promise); });
}

void check_values(const std::string& path, const std::vector<SparseVolume>& volumes, TargetKind target) {
  std::set<std::string> names;
  for (const SparseVolume& volume : volumes) {
    if (promise_of(volume.name(), target) && !names.insert(volume.name()).second) {
      throw Error{Fault::data, input_name(path) + ": " + occurs_twice(volume.name())};
    }
    check_values(path, volume, target);
  }
}

}  // namespace vam::io
