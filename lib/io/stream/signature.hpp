// SPDX-License-Identifier: GPL-3.0-or-later
// What a file of another program is, by its first bytes: for messages, which must not call it what it is not.
#pragma once

#include <string>
#include <string_view>

namespace vam::io {

/// "a NumPy array (.npy)", "compressed by gzip": fits behind "is". Empty for bytes without a known signature. 400 bytes
/// suffice, but for XML whose root element comes later.
[[nodiscard]] std::string foreign_format(std::string_view head);

/// What makes such a file readable: "; unpack it", the end of a message. Empty where nothing does.
[[nodiscard]] std::string foreign_remedy(std::string_view head);

}  // namespace vam::io
