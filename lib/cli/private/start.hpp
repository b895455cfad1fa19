// SPDX-License-Identifier: GPL-3.0-or-later
// The time before main(), in which libraries ask for memory and threads and nobody catches: OpenVDB's log starts four
// threads, none of which is started. Between the two calls a process to which memory is refused ends as for any lack of
// it, with a line and its status, not by a signal.
#pragma once

namespace vam::cli {

/// Before the initialisers of all libraries.
void start_begins() noexcept;

/// From here on App::run catches.
void start_ends() noexcept;

}  // namespace vam::cli
