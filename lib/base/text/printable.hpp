// SPDX-License-Identifier: GPL-3.0-or-later
// Names come from outside and may hold any byte; a terminal obeys some of them, a page others.
#pragma once

#include <string>
#include <string_view>

namespace vam {

/// Control characters (ASCII, and C1 in UTF-8), marks that turn the direction of text, and bytes that are no UTF-8,
/// become \n, \t or \x1b; the rest stays as it is.
[[nodiscard]] std::string printable(std::string_view text);

/// In quotes, for a message: 'text', printable(); of a longer one than 64 bytes its begin: 'text...' (200000 bytes).
[[nodiscard]] std::string excerpt(std::string_view text);

/// The same without quotes, for names in a list.
[[nodiscard]] std::string briefly(std::string_view text);

/// As text of a page, or as the quoted value of an attribute: printable(), with <, >, &, " and ' as entities.
[[nodiscard]] std::string page_text(std::string_view text);

/// As part of a link in a page: all but letters, digits and ._-~ as %xx, so that it also ends no attribute.
[[nodiscard]] std::string link_text(std::string_view name);

}  // namespace vam
