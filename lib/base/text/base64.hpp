// SPDX-License-Identifier: GPL-3.0-or-later
// Bytes as text, for images within a page.
#pragma once

#include <string>
#include <string_view>

namespace vam {

/// RFC 4648, section 4, padded, in one line.
[[nodiscard]] std::string base64(std::string_view bytes);

}  // namespace vam
