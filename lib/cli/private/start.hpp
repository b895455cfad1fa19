// SPDX-License-Identifier: GPL-3.0-or-later
// The time before main(), in which libraries ask for memory and threads and nobody catches: OpenVDB's log starts four
// threads, none of which is started. There, and in threads of libraries later, a process to which memory is refused
// ends as for any lack of it, with a line and its status, not by a signal.
#pragma once

namespace vam::cli {

/// Before the initialisers of all libraries.
void start_begins() noexcept;

}  // namespace vam::cli
