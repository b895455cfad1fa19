// SPDX-License-Identifier: GPL-3.0-or-later
// Private to the VDB files: validation of an archive's header before it is passed to OpenVDB.
#pragma once

#include <span>

namespace vam::io {

/// Whether an archive begins there.
[[nodiscard]] bool is_archive(std::span<const char> bytes);

/// Walks the head of an archive (file metadata, first grid's descriptor and metadata) as far as `bytes` show it.
/// OpenVDB takes the memory that a size there asks for before it finds that the bytes do not follow.
/// Throws std::runtime_error: not VDB, a format newer than the library's, a size or count that cannot be.
void check_head(std::span<const char> bytes);

}  // namespace vam::io
