// SPDX-License-Identifier: GPL-3.0-or-later
// The images of a capture folder, held to its manifest.
#include <array>
#include <cstdio>
#include <filesystem>

#include "base/error.hpp"
#include "base/fingerprint.hpp"
#include "base/log/log.hpp"
#include "base/log/log_lines.hpp"
#include "base/system_error.hpp"
#include "base/text/printable.hpp"
#include "io/image/capture_folder.hpp"
#include "io/image/image_file.hpp"
#include "io/image/private/capture_manifest.hpp"

namespace vam::io {

namespace {

namespace fs = std::filesystem;

std::string image_path(const std::string& folder, long place) {
  return (fs::path(folder) / capture_file_name(place)).string();
}

std::string no_end(const std::string& folder) {
  return manifest_path(folder) +
         ": does not end as that of a capture that ended: it was killed, or the last lines are gone; repeat "
         "vam-capture, which completes it, or restore the manifest";
}

// Behind the line of the end there is nothing but what a further capture writes.
std::string more_bytes(const std::string& folder, const CaptureManifest& manifest) {
  return manifest_path(folder) + ": has " + std::to_string(manifest.cut_bytes) +
         " bytes of no whole line behind the end of the capture; remove them, or repeat vam-capture, which cuts them "
         "off";
}

}  // namespace

std::set<std::string> images_of(const std::string& folder) {
  std::error_code problem;
  std::set<std::string> names;
  for (fs::directory_iterator entry(folder, problem), end; !problem && entry != end; entry.increment(problem)) {
    if (is_image_file(entry->path().string())) names.insert(entry->path().filename().string());
  }
  if (problem) throw system_error(Fault::no_input, folder + ": cannot read the folder", problem.value());
  return names;
}

std::set<std::string> unlisted(const CaptureManifest& manifest, std::set<std::string> images) {
  for (const auto& [place, record] : manifest.frames) images.erase(capture_file_name(place));
  return images;
}

std::string without_line(const std::string& folder, const std::set<std::string>& names) {
  return (fs::path(folder) / *names.begin()).string() + ": has no line in manifest.jsonl" +
         (names.size() > 1 ? ", as " + std::to_string(names.size() - 1) + " more images" : "") +
         "; restore the manifest, or remove what does not belong to the capture";
}

std::string capture_file_name(long place) {
  std::array<char, 32> name{};
  std::snprintf(name.data(), name.size(), "%06ld.png", place);
  return name.data();
}

GreyImage read_captured(const std::string& folder, const CaptureRecord& record) {
  const std::string path = image_path(folder, record.place);
  if (!has_regular_file(path)) {  // a pipe would be waited for
    throw Error{Fault::no_input, path +
                                     ": is gone, but manifest.jsonl lists it; restore it, or repeat vam-capture, "
                                     "which captures it again"};
  }
  GreyImage image = read_image(path);
  require_captured(path, record, image);
  return image;
}

void require_captured(const std::string& path, const CaptureRecord& record, const GreyImage& image) {
  if (record.levels.empty()) return;
  const std::string read = fingerprint(image);
  if (read == record.levels) return;
  throw Error{Fault::data, path + ": is not the image that was captured (fingerprint " +
                               excerpt(record.levels.substr(0, 8)) + " in manifest.jsonl, read " + read.substr(0, 8) +
                               "); restore it, or delete it and repeat vam-capture"};
}

CaptureManifest open_capture(const std::string& folder) {
  const std::set<std::string> images = images_of(folder);  // before the manifest: a capture may be going on
  CaptureManifest manifest = read_manifest(folder);
  const std::set<std::string> more = unlisted(manifest, images);
  // One is what a capture leaves that was killed between the image and its line.
  const std::size_t allowed = manifest.sealed && manifest.ended ? 0 : 1;
  if (more.size() > allowed) throw Error{Fault::data, without_line(folder, more)};
  if (manifest.ended && manifest.cut_bytes > 0) throw Error{Fault::data, more_bytes(folder, manifest)};
  if (manifest.sealed && !manifest.ended) warn(no_end(folder));
  return manifest;
}

std::vector<std::string> capture_damage(const std::string& folder, const CaptureManifest& manifest, bool fast) {
  std::vector<std::string> damage;
  for (const auto& [place, record] : manifest.frames) {
    try {
      const std::string path = image_path(folder, place);
      if (!fast || !has_regular_file(path)) (void)read_captured(folder, record);
    } catch (const Error& error) {  // the others are looked at, too
      damage.emplace_back(error.what());
    }
  }
  if (const auto more = unlisted(manifest, images_of(folder)); !more.empty())
    damage.push_back(without_line(folder, more));
  if (manifest.sealed && !manifest.ended) damage.push_back(no_end(folder));
  if (manifest.ended && manifest.cut_bytes > 0) damage.push_back(more_bytes(folder, manifest));
  return damage;
}

}  // namespace vam::io
