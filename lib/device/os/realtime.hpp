// SPDX-License-Identifier: GPL-3.0-or-later
// Real-time priority for threads that control a device.
#pragma once

namespace vam::device {

/// What waits for whom: a guardian acts even while the tool that it guards computes.
enum class Urgency { driver = 1, guardian = 2 };

/// The calling thread, which must sleep most of the time, goes before all others of the machine from now on: in real
/// time (SCHED_RR) where the system permits it (root, or RLIMIT_RTPRIO of 2), else as far as its nice limit goes, which
/// for a plain user is no further. What it starts goes as usual.
void hurry(Urgency urgency);

}  // namespace vam::device
