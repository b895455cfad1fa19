// SPDX-License-Identifier: GPL-3.0-or-later
// Private to what opens files: temporary names that vanish when the process is interrupted, pipes, endless devices.
#pragma once

#include <sys/stat.h>

#include <string>

namespace vam::io {

/// Creates an empty file ".vam-<pid>-<n>" beside `target` and lists its name, so that SIGHUP, SIGINT and
/// SIGTERM remove it before they end the process (unless they are handled or ignored elsewhere).
/// Such names that a dead process has left there (SIGKILL, a loss of power) are removed first.
/// Returns the descriptor, or -1 with errno set.
int create_temporary(const std::string& target, std::string& name, int& slot);

/// Gives the unnamed file behind `descriptor` a temporary name beside `target`, listed in the same way. Returns 0, or
/// -1 with errno set.
int name_temporary(int descriptor, const std::string& target, std::string& name, int& slot);

/// The same for a folder that will hold files, no folders. Returns 0, or -1 with errno set.
int create_temporary_folder(const std::string& target, std::string& name, int& slot);

/// Removes what dead processes left in the folder of `target`; once a folder and process.
void sweep_folder_of(const std::string& target);

/// Waits until the disk knows the names in the folder of `target`; what it does not know would be gone after a loss of
/// power. File systems that cannot are left in peace; throws Fault::io where the disk fails.
void synchronise_folder_of(const std::string& target);

/// The name is no longer temporary.
void forget_temporary(int slot);

/// What a pipe is asked to hold, so that writer and reader seldom wait for each other.
inline constexpr int pipe_bytes = 1 << 20;

/// Throws Fault::no_input for /dev/zero, full, random and urandom. `name` begins the message.
void require_end(const struct stat& about, const std::string& name);

}  // namespace vam::io
