// SPDX-License-Identifier: GPL-3.0-or-later
// Private to the VDB files: archives off a file or a pipe, with the errors of these tools.
#pragma once

#include <functional>
#include <istream>

#include "io/stream/stream.hpp"

namespace vam::io {

/// Calls `archive` at the start of each archive until the file ends; it must read its archive whole. Throws Fault::data
/// for what is empty, cut off or not OpenVDB, and for any std::exception of the reader but
/// std::bad_alloc: the child knows whose limit was met.
void for_archives(InputFile& file, const std::function<void(std::istream&)>& archive);

}  // namespace vam::io
