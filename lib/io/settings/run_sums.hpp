// SPDX-License-Identifier: GPL-3.0-or-later
// SHA256SUMS of a run folder: the hashes of its files, which vam-print writes when the print has ended.
#pragma once

#include <map>
#include <string>
#include <vector>

namespace vam::io {

/// Hashes of 64 digits by the names of files, relative to their folder.
using RunSums = std::map<std::string, std::string>;

/// Is there such a list? Throws as has_regular_file() does.
[[nodiscard]] bool has_run_sums(const std::string& folder);

/// As sha256sum(1) writes it. Throws Fault::data where a line is no hash and name of a file in the folder, or none is.
[[nodiscard]] RunSums read_run_sums(const std::string& folder);

/// The logs, records and settings of a print that has ended are what they were at its end. Throws Fault::data where one
/// of the list was changed, is gone or a link, or the list has no hash of those by which light is counted; without a
/// list, as of a print that was killed, only these must not be links, and the settings must be sealed. Throws as
/// read_run_sums() does.
void require_run_logs(const std::string& folder);

/// Of a print that has not ended: throws Fault::data where the settings are gone that vam-print writes before its
/// events.
void require_run_settings(const std::string& folder);

/// Throws Fault::data where a log, record or report states a version that is not read.
void require_run_versions(const std::string& folder);

/// What is wrong with a file of the list, as a line; empty: nothing.
[[nodiscard]] std::string sum_problem(const std::string& folder, const RunSums::value_type& file);

/// What differs, is gone, a link or not in the list, a line each; with `fast` no file of the list is read.
/// resumed.json, which a resumption adds, need not be in it, nor sinogram.exr, a link or its copy, which is held to the
/// hash in the events; warns where it leads nowhere.
[[nodiscard]] std::vector<std::string> run_damage(const std::string& folder, const RunSums& sums, bool fast);

}  // namespace vam::io
