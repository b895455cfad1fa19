// SPDX-License-Identifier: GPL-3.0-or-later
// The end of a zip archive, which libzip looks for anywhere in the last bytes of a file.
#pragma once

#include <cstdint>
#include <string_view>

namespace vam::io {

/// Bytes behind the last end record that a zip archive has, and its comment (PKWARE APPNOTE section 4.3.16); 0 where
/// it has none, or it is cut.
[[nodiscard]] std::uint64_t bytes_behind_zip(std::string_view bytes);

}  // namespace vam::io
