// SPDX-License-Identifier: GPL-3.0-or-later
// The versions of the files' formats [formats: FORMAT VERSIONS]: the one table, and the one check.
#pragma once

#include <string>
#include <string_view>

namespace vam {

struct FormatVersion {
  std::string_view kind;  // of JSON: the name in its key "schema"
  int version;            // that is written, and the newest that is read; counts up when a meaning changes or goes
};

inline constexpr FormatVersion format_versions[] = {
    {"volume", 1},
    {"stack", 1},
    {"video", 1},
    {"NRRD", 1},
    {"printer file", 1},
    {"checkpoint", 6},
    {"vam-angles", 1},
    {"vam-bench", 1},
    {"vam-calibration", 1},
    {"vam-capture", 1},
    {"vam-correct", 1},
    {"vam-critical-dose", 1},
    {"vam-cure-depth", 1},
    {"vam-curethrough-correct", 1},
    {"vam-curethrough-model", 1},
    {"vam-curethrough-sweep", 2},
    {"vam-devices", 1},
    {"vam-dose", 1},
    {"vam-log", 1},
    {"vam-optimize", 1},
    {"vam-ost", 1},
    {"vam-photodiode", 1},
    {"vam-plan", 1},
    {"vam-print", 1},
    {"vam-project", 1},
    {"vam-resin", 1},
    {"vam-score", 1},
    {"vam-score-grey", 1},
    {"vam-sdf", 1},
    {"vam-sdf-height", 1},
    {"vam-sdf-trend", 1},
    {"vam-slice", 1},
    {"vam-working-curve", 1},
};

[[nodiscard]] constexpr const FormatVersion* find_format(std::string_view kind) {
  for (const FormatVersion& format : format_versions) {
    if (format.kind == kind) return &format;
  }
  return nullptr;
}

/// One of the table; the name of none does not compile.
class FormatKind {
 public:
  consteval FormatKind(const char* kind) : FormatKind(*find_format(kind)) {}
  constexpr explicit FormatKind(const FormatVersion& entry) : entry_(&entry) {}
  [[nodiscard]] std::string_view kind() const { return entry_->kind; }
  /// "1"
  [[nodiscard]] std::string version() const { return std::to_string(entry_->version); }
  /// "vam-slice/1"
  [[nodiscard]] std::string schema() const { return std::string(kind()) + "/" + version(); }
  /// What an error says of a file that states this version, behind its name; empty where it is read.
  [[nodiscard]] std::string objection(std::string_view stated) const;

 private:
  const FormatVersion* entry_;
};

/// Of volumes, stacks and NRRD: the key of the version, in text.
inline constexpr const char* version_name = "vam:version";

/// The same of a schema, "vam-slice/1"; empty for those of other programs, too.
[[nodiscard]] std::string schema_objection(std::string_view schema);

}  // namespace vam
