// SPDX-License-Identifier: GPL-3.0-or-later
// The name under which ps and pkill know a process.
#pragma once

#include <string>

namespace vam::device {

inline constexpr const char* guardian_name = "vam-guardian";  // pkill spares it, with whatever its tool is killed by

/// Of this process, which forgets its command line: `name` is what pkill finds, by name and (-f) by command line. At
/// most 15 bytes. For a child that was forked and has no threads.
void name_process(const std::string& name);

}  // namespace vam::device
