// SPDX-License-Identifier: GPL-3.0-or-later
// The last line of the terminal behind stderr, which shows where the work stands.
#pragma once

#include <string>

namespace vam::status_line {

/// Is stderr a terminal?
[[nodiscard]] bool possible();

/// Characters that the line has room for: one less than the terminal has columns, so that it never breaks.
[[nodiscard]] int width();

/// Puts the text there, cut to the width. Nothing where another process has the line: the tools of a pipe take turns,
/// each until it hides its line or ends.
void show(const std::string& text);

/// Clears the line and leaves it to others.
void hide();

/// Before other text on stderr: clears the line, this process's or another's, which shows it again when it goes on.
void make_way();

}  // namespace vam::status_line
