// SPDX-License-Identifier: GPL-3.0-or-later
// Where a zip archive begins and ends: libzip looks for its end in the last bytes of a file, and for all else from
// there.
#pragma once

#include <cstdint>
#include <string_view>

namespace vam::io {

/// Bytes behind the last end record that a zip archive has, and its comment (PKWARE APPNOTE section 4.3.16); 0 where
/// it has none, or it is cut.
[[nodiscard]] std::uint64_t bytes_behind_zip(std::string_view bytes);

/// The number of bytes before the archive that ends where they end, as of another archive; 0 where none does, and for
/// ZIP64.
[[nodiscard]] std::uint64_t bytes_before_zip(std::string_view bytes);

}  // namespace vam::io
