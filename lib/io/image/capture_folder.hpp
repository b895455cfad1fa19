// SPDX-License-Identifier: GPL-3.0-or-later
// A camera's frames as a folder that grows, and that a later capture can go on with: numbered PNG files and
// manifest.jsonl, a line of JSON a frame behind a head line. A frame is on the disk before its line is. Every line has
// the fingerprint of its image and a seal over itself and the seal before, so that no line and no image can change, go
// or be exchanged unseen; the line that ends a capture states how many frames there are.
#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "base/pixels.hpp"
#include "base/text/json_fwd.hpp"
#include "io/stream/seal.hpp"

namespace vam::io {

/// One line of the manifest.
struct CaptureRecord {
  long place = 0;   // in the series: the file is named after it
  long number = 0;  // of the frame since the camera started; a gap is frames that were lost
  double t_monotonic_s = 0;
  std::optional<double> time_sigma_s, device_s, angle_deg, sigma_deg;
  bool complete = true;
  std::string levels;  // fingerprint of the grey levels; empty: not known
};

[[nodiscard]] std::string capture_file_name(long place);  // "000012.png"

struct CaptureManifest {
  std::string head;                      // the first line
  std::map<long, CaptureRecord> frames;  // the last line of each place counts, unless it is worse than one before
  long dropped = 0;
  bool sealed = false;
  bool ended = false;         // its last line is that of the end of a capture
  std::size_t cut_bytes = 0;  // behind the last whole line
  Digest seal;                // of the last line
};

/// Is there a manifest in this folder?
[[nodiscard]] bool is_capture_folder(const std::string& folder);
/// A last line that was cut off is no line. One of another program has no seals and is taken as it is. Throws Error:
/// no_input, data.
[[nodiscard]] CaptureManifest read_manifest(const std::string& folder);

/// Of a folder whose frames are to be read: warns where a sealed manifest has no end, and refuses what stands behind
/// that end, and images without a line but the one that a capture which was killed may leave. Throws as read_manifest
/// does.
[[nodiscard]] CaptureManifest open_capture(const std::string& folder);

/// The image of a frame. Throws Fault::data where it is not the one that was captured, and as read_image does.
[[nodiscard]] GreyImage read_captured(const std::string& folder, const CaptureRecord& record);

/// For an image that was read already; `path` begins the message.
void require_captured(const std::string& path, const CaptureRecord& record, const GreyImage& image);

/// What is no longer as it was captured, a line each; with `fast` images are not read. Throws as read_manifest does.
[[nodiscard]] std::vector<std::string> capture_damage(const std::string& folder, const CaptureManifest& manifest,
                                                      bool fast);

class CaptureFolder {
 public:
  /// Makes the folder, or resumes an existing one, whose images are held to the manifest: those that are gone are
  /// missing frames. Throws Fault::no_output when its head differs ("was taken with exposure_us 20000, not 10000"), or
  /// it holds other things; lag_ms and speed_deg_s are compared where they are stated. Throws Fault::data where images
  /// or manifest are not what was captured, or the manifest is empty.
  CaptureFolder(const std::string& folder, const Json& head);
  ~CaptureFolder();
  CaptureFolder(const CaptureFolder&) = delete;
  CaptureFolder& operator=(const CaptureFolder&) = delete;

  /// Is there a complete frame at this place?
  [[nodiscard]] bool has(long place) const;
  /// Of record.levels whatever it says: the fingerprint is that of the image. Throws Fault::io, no_output.
  void keep(CaptureRecord record, const GreyImage& levels);
  void dropped(long first, long last);
  /// Writes that the capture has ended, if that is not what the last line says; warns where it joined new images to
  /// those of an earlier one. Throws Fault::io, and Fault::data where
  /// an image that was there before has no line still.
  void end();

 private:
  void require_images();
  void write_line(Json line);
  std::string folder_;
  CaptureManifest manifest_;
  std::set<long> gone_;             // places of frames whose images are
  long earlier_ = 0;                // images of captures before this one
  std::set<long> fresh_;            // places of those of this one
  std::set<std::string> unlisted_;  // images without a line
  int log_ = -1;
};

}  // namespace vam::io
