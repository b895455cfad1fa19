// SPDX-License-Identifier: GPL-3.0-or-later
// Projections as they play, and the sinograms that they come from.
#pragma once

#include <string>

#include "io/stream/file_type.hpp"

namespace vam::report_tool {

/// HTML of a stack, a video or a folder of frames, with at most `count` images of each kind. Throws what its readers
/// throw.
[[nodiscard]] std::string light_view(const std::string& path, io::FileType type, int count);

}  // namespace vam::report_tool
