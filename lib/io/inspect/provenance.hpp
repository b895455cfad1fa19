// SPDX-License-Identifier: GPL-3.0-or-later
// What a file was made by, and whether it is still what was written.
#pragma once

#include <string>
#include <vector>

namespace vam::io {

/// One image stack, grid, video or text.
struct ProvenanceEntry {
  std::string what;                      // "stack of 120 images", "grid 'target'"
  bool sealed = false;                   // and held to it
  std::string seal;                      // 16 digits; empty where there is none, or it is not known
  std::vector<std::string> history;      // with the lines of seals
  bool checksums = false;                // of a video of any program: those of its container are valid
  std::vector<std::string> damage = {};  // of a folder: what differs, is gone or does not belong to it, a line each
  std::vector<std::string> facts = {};   // of a print: run_facts()
};

/// Reads the file, or with `fast` its headers alone. Throws Fault::data where it is not what was written, and what its
/// readers throw. "-" is stdin.
[[nodiscard]] std::vector<ProvenanceEntry> inspect(const std::string& path, bool fast);

/// A command of a history and the seal of the file that it wrote; empty where that is not known.
struct Step {
  std::string command;
  std::string seal;
};
[[nodiscard]] std::vector<Step> chain_of(const ProvenanceEntry& finding);

}  // namespace vam::io
