// SPDX-License-Identifier: GPL-3.0-or-later
// Private to the VDB files: archives off a file or a pipe, in the process that parses them; each head is validated
// before it is passed to OpenVDB.
#pragma once

#include <functional>
#include <istream>
#include <span>

#include "io/stream/stream.hpp"

namespace vam::io {

/// Calls `archive` at the start of each archive until the file ends; it must read its archive whole. Throws
/// std::runtime_error, to stand behind the file's name, for what is empty, cut off or not OpenVDB; and what the reader
/// throws.
void for_archives(InputFile& file, const std::function<void(std::istream&)>& archive);

/// Whether an archive begins there.
[[nodiscard]] bool is_archive(std::span<const char> bytes);

/// Walks the head of an archive (file metadata, first grid's descriptor and metadata) as far as `bytes` show it.
/// OpenVDB takes the memory that a size there asks for before it finds that the bytes do not follow.
/// Throws std::runtime_error: not VDB, a format newer than the library's, a size or count that cannot be.
void check_head(std::span<const char> bytes);

}  // namespace vam::io
