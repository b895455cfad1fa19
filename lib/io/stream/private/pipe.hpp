// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace vam::io {

/// What a pipe is asked to hold, so that writer and reader seldom wait for each other.
inline constexpr int pipe_bytes = 1 << 20;

}  // namespace vam::io
