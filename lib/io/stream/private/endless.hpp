// SPDX-License-Identifier: GPL-3.0-or-later
// Private to what opens files: devices whose bytes never end.
#pragma once

#include <sys/stat.h>

#include <string>

namespace vam::io {

/// Throws Fault::no_input for /dev/zero, full, random and urandom. `name` begins the message.
void require_end(const struct stat& about, const std::string& name);

}  // namespace vam::io
