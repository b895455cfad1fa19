// SPDX-License-Identifier: GPL-3.0-or-later
// The child's side of the guardian.
#pragma once

namespace vam::device {

/// Serves the socket until the parent is gone or has requested the end, acts, and leaves the process.
/// Packets: kind, number, blank, text, and a descriptor where one belongs: 'a' add an action, 'f' forget it, 'k' keep
/// the descriptor, 'b' beat, 'q' act now without a word on stderr.
[[noreturn]] void guard(int socket, int parent, double stall_s);

}  // namespace vam::device
