// SPDX-License-Identifier: GPL-3.0-or-later
// Private to the VDB files: archives off a file or a pipe, in the process that parses them.
#pragma once

#include <functional>
#include <istream>

#include "io/stream/stream.hpp"

namespace vam::io {

/// Calls `archive` at the start of each archive until the file ends; it must read its archive whole. Throws
/// std::runtime_error, to stand behind the file's name, for what is empty, cut off or not OpenVDB; and what the reader
/// throws.
void for_archives(InputFile& file, const std::function<void(std::istream&)>& archive);

}  // namespace vam::io
