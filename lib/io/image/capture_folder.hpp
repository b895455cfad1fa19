// SPDX-License-Identifier: GPL-3.0-or-later
// A camera's frames as a folder that grows, and that a later capture can go on with: numbered PNG files and
// manifest.jsonl, a line of JSON a frame behind a head line. A frame is on the disk before its line is.
#pragma once

#include <map>
#include <optional>
#include <string>

#include "base/json_fwd.hpp"
#include "base/pixels.hpp"

namespace vam::io {

/// One line of the manifest.
struct CaptureRecord {
  long place = 0;   // in the series: the file is named after it
  long number = 0;  // of the frame since the camera started; a gap is frames that were lost
  double t_monotonic_s = 0;
  std::optional<double> time_sigma_s, device_s, angle_deg, sigma_deg;
  bool complete = true;
  std::string levels;  // fingerprint of the grey levels
};

[[nodiscard]] std::string capture_file_name(long place);  // "000012.png"

struct CaptureManifest {
  std::string head;                      // the first line
  std::map<long, CaptureRecord> frames;  // the last line of each place counts, unless it is worse than one before
  long dropped = 0;
};

/// Is there a manifest in this folder?
[[nodiscard]] bool is_capture_folder(const std::string& folder);
/// A last line that was cut off is no line. Throws Error: no_input, data.
[[nodiscard]] CaptureManifest read_manifest(const std::string& folder);

class CaptureFolder {
 public:
  /// Makes the folder, or resumes an existing one. Throws Fault::no_output when its head differs ("was taken
  /// with exposure_us 20000, not 10000"), or it holds other things.
  CaptureFolder(const std::string& folder, const Json& head);
  ~CaptureFolder();
  CaptureFolder(const CaptureFolder&) = delete;
  CaptureFolder& operator=(const CaptureFolder&) = delete;

  /// Is there a complete frame at this place?
  [[nodiscard]] bool has(long place) const;
  /// Throws Fault::io.
  void keep(const CaptureRecord& record, const GreyImage& levels);
  void dropped(long first, long last);

 private:
  void write_line(const Json& line);
  std::string folder_;
  CaptureManifest manifest_;
  int directory_ = -1;
  int log_ = -1;
};

}  // namespace vam::io
