// SPDX-License-Identifier: GPL-3.0-or-later
// A process that controls a device: the priority of its threads, the name under which ps and pkill know it.
#pragma once

#include <string>

namespace vam::device {

/// What waits for whom: a guardian acts even while the tool that it guards computes.
enum class Urgency { driver = 1, guardian = 2 };

/// The calling thread, which must sleep most of the time, goes before all others of the machine from now on: in real
/// time (SCHED_RR) where the system permits it (root, or RLIMIT_RTPRIO of 2), else as far as its nice limit goes, which
/// for a plain user is no further. What it starts goes as usual.
void hurry(Urgency urgency);

/// The calling thread, which was in a hurry, has nothing left to control.
void take_time();

inline constexpr const char* guardian_name = "vam-guardian";  // pkill spares it, with whatever its tool is killed by

/// Of this process, which forgets its command line: `name` is what pkill finds, by name and (-f) by command line. At
/// most 15 bytes. For a child that was forked and has no threads.
void name_process(const std::string& name);

}  // namespace vam::device
