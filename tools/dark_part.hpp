// SPDX-License-Identifier: GPL-3.0-or-later
// Part voxels that no ray reaches.
#pragma once

#include <cstdint>
#include <string>

#include "base/log.hpp"
#include "io/stream/input_name.hpp"

namespace vam::tool {

/// A warning if there are any in the part of the file.
inline void warn_of_dark_part(const std::string& path, std::int64_t voxels) {
  if (voxels <= 0) return;
  warn(io::input_name(path) + ": the insert shadows " + std::to_string(voxels) +
       " voxels of the part from all stage angles; they will not print");
}

}  // namespace vam::tool
