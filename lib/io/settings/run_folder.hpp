// SPDX-License-Identifier: GPL-3.0-or-later
// The run folder of a print (vam-print): what its events state, that nothing of it was changed, and which print goes on
// with which, as what remains of one that was aborted is given once.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "base/text/json_fwd.hpp"

namespace vam::io {

/// events.jsonl: what was armed, how it ended, and how much there was of the other logs.
struct RunEvents {
  double turns = 0;  // 0: none was armed
  double from_deg = 0;
  std::string armed_utc, sinogram_sha256;
  std::string resumes, resumes_utc;    // the folder of the print of which this is the rest, and when that was armed
  std::string resumed_by;              // empty: not resumed, or that was taken back
  std::optional<std::string> outcome;  // none while it goes on, or of one that was killed
  std::string ended_utc;               // likewise
  int status = 0;
  struct Log {
    std::uint64_t bytes = 0;  // of whole lines
    std::string chain, utc;   // of the last one; when
  };
  std::map<std::string, Log> logs;  // as last stated, by their names
};

/// None of a folder without. Throws as LogLines does.
[[nodiscard]] RunEvents read_events(const std::string& run);

/// Maker, model and serial number of a device, or of the camera in what vam-capture says of it, as far as it has them.
[[nodiscard]] std::string device_name(const Json& identity);

/// What drove light, stage and camera, as the first lines of their logs name it.
struct UsedDevice {
  std::string what;  // stage, camera, display, light
  std::string device;
  bool simulated = false;
};
[[nodiscard]] std::vector<UsedDevice> used_devices(const std::string& run);

/// Whether somebody prints: vam-print keeps a lock on its events until the last tool has ended.
[[nodiscard]] bool is_printed(const std::string& run);

/// What was printed, when, with what, and how far it was delivered, a line each. Throws as FlipLog does.
[[nodiscard]] std::vector<std::string> run_facts(const std::string& run);

/// Every log of the folder is a whole chain, and those that the events state are as long at least. Throws Fault::data.
void require_logs(const std::string& run);

/// Up to where the events state the flips, in words; empty: they do not.
[[nodiscard]] std::string sealed_flips(const std::string& run);

/// Hashes of 64 digits by the names of files, relative to their folder.
using RunSums = std::map<std::string, std::string>;

/// Is there such a list? Throws as has_regular_file() does.
[[nodiscard]] bool has_run_sums(const std::string& folder);

/// As sha256sum(1) writes it. Throws Fault::data where a line is no hash and name of a file in the folder, or none is.
[[nodiscard]] RunSums read_run_sums(const std::string& folder);

/// The logs, records and settings of a print that has ended are what they were at its end. Throws Fault::data where one
/// of the list was changed or is gone, or the list has no hash of those by which light is counted; without a list, as
/// of a print that was killed, the settings must be sealed; throws then as require_run_versions() and require_logs()
/// do, otherwise as read_run_sums().
void require_run_logs(const std::string& folder);

/// Of a print that has not ended: throws Fault::data where the settings are gone that vam-print writes before its
/// events.
void require_run_settings(const std::string& folder);

/// What is needed of a print to go on with it is there, and what it was. Throws Fault::no_input where there is no
/// folder; as require_run_logs(), require_run_settings() and require_resumption().
void require_run(const std::string& folder);

/// Throws Fault::data where a log, record or report states a version that is not read, or a key twice.
void require_run_versions(const std::string& folder);

/// What differs, is gone or not in the list, a line each; with `fast` no file of the list is read.
/// resumed.json, which a resumption adds, need not be in it, nor sinogram.exr, a link or its copy, which is held to the
/// hash in the events; warns where it leads nowhere.
[[nodiscard]] std::vector<std::string> run_damage(const std::string& folder, const RunSums& sums, bool fast);

/// Throws Fault::data where the resumed.json of a run folder does not say when and by which print it was resumed, or is
/// gone though events.jsonl states it ("resumed", unless "released" follows).
void require_resumption(const std::string& run);

/// The print that resumed this one, by its resumed.json; empty: none.
[[nodiscard]] std::string resumed_by(const std::string& run);

/// Does a run resume this one? By when that was armed and by the sinogram, so that both may have been moved.
[[nodiscard]] bool resumes(const std::string& run, const std::string& earlier);

/// Of these run folders a line for each without resumed.json of which another one showed the rest.
[[nodiscard]] std::vector<std::string> unmarked_resumptions(const std::vector<std::string>& runs);

}  // namespace vam::io
