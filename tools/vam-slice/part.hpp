// What is to be sliced: a mesh, images or a shape, and what it is printed around.
#pragma once

#include <optional>

#include "solid/voxel/part.hpp"
#include "vam-slice/options.hpp"

namespace vam::slice_tool {

[[nodiscard]] solid::Part part_of(const Options& options, const solid::Writable& room);

/// Of its own size, where the options put it.
[[nodiscard]] std::optional<solid::Part> insert_of(const Options& options, const solid::Part& part,
                                                   const solid::Writable& room);

}  // namespace vam::slice_tool
