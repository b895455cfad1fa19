// SPDX-License-Identifier: GPL-3.0-or-later
// Private to the video files: what a Matroska file says of its own wholeness.
#pragma once

#include <string>

namespace vam::io {

/// Throws Fault::data where a Matroska file is shorter than its segment, or where one of the checksums that its parts
/// begin with is wrong (CRC-32, RFC 8794 section 11.3.1; a part without one among parts that have one is damaged, too,
/// as are bytes behind them). libav checks neither, and takes the end of a cut file for the end of the film. True when
/// its parts have checksums; false for files of other kinds.
bool require_whole_matroska(const std::string& path);

}  // namespace vam::io
