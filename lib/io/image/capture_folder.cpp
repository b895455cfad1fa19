// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/image/capture_folder.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>
#include <iterator>

#include "base/error.hpp"
#include "base/fingerprint.hpp"
#include "base/log/log.hpp"
#include "base/log/log_lines.hpp"
#include "base/system_error.hpp"
#include "base/text/json.hpp"
#include "base/text/printable.hpp"
#include "io/image/image_file.hpp"
#include "io/image/private/capture_manifest.hpp"
#include "io/stream/stream.hpp"

namespace vam::io {

namespace {

namespace fs = std::filesystem;

Error failed(const std::string& path) { return system_error(Fault::io, path + ": cannot be written", errno); }

// Whole and on the disk, or an Error.
void write_synced(int file, const std::string& bytes, const std::string& path) {
  std::size_t done = 0;
  while (done < bytes.size()) {
    const ssize_t now = write(file, bytes.data() + done, bytes.size() - done);
    if (now < 0 && errno == EINTR) continue;
    if (now <= 0) throw failed(path);
    done += static_cast<std::size_t>(now);
  }
  if (fdatasync(file) != 0 && errno != EINVAL) throw failed(path);
}

Json to_line(const CaptureRecord& record) {
  Json line{{"frame", record.place},
            {"file", capture_file_name(record.place)},
            {"number", record.number},
            {"t_monotonic_s", record.t_monotonic_s}};
  if (record.time_sigma_s) line["time_sigma_s"] = *record.time_sigma_s;
  if (record.device_s) line["device_s"] = *record.device_s;
  if (record.angle_deg) line["angle_deg"] = *record.angle_deg;
  if (record.sigma_deg) line["sigma_deg"] = *record.sigma_deg;
  line["complete"] = record.complete;
  line["levels"] = record.levels;
  return line;
}

// "exposure_us 20000, not 10000": the first thing that differs.
std::string difference(const Json& there, const Json& wanted) {
  for (const auto& [key, value] : wanted.items()) {
    const auto found = there.find(key);
    const bool is_recent = key == "lag_ms" || key == "speed_deg_s";
    if (found == there.end() && is_recent) continue;
    if (found == there.end() || *found != value) {
      return key + " " + (found == there.end() ? "unknown" : briefly(found->dump())) + ", not " + briefly(value.dump());
    }
  }
  for (const auto& [key, value] : there.items()) {
    if (key != manifest_seal_key && !wanted.contains(key)) return key + " " + briefly(value.dump()) + ", not unknown";
  }
  return "";
}

// "000003.png, 000010.png to 000012.png"
std::string names_of(const std::set<long>& places) {
  std::string text;
  for (auto first = places.begin(); first != places.end();) {
    auto last = first;
    while (std::next(last) != places.end() && *std::next(last) == *last + 1) ++last;
    text += (text.empty() ? "" : ", ") + capture_file_name(*first);
    if (last != first) text += " to " + capture_file_name(*last);
    first = std::next(last);
  }
  return text;
}

}  // namespace

CaptureFolder::CaptureFolder(const std::string& folder, const Json& head) : folder_(folder) {
  std::error_code problem;
  fs::create_directories(folder, problem);
  if (problem || !fs::is_directory(folder)) {
    throw Error{Fault::no_output, folder + ": cannot make the folder (" + problem.message() + ")"};
  }
  const std::string path = manifest_path(folder);
  const bool there = has_regular_file(path);
  // Without images an empty one is that of a capture that was killed before its first line.
  const bool again = there && (fs::file_size(path) > 0 || !images_of(folder).empty());
  if (!again && !fs::is_empty(folder) && !there) {
    throw Error{Fault::no_output, folder + ": contains files of another kind; name another folder"};
  }
  if (again) {
    manifest_ = read_manifest(folder);
    const std::string other = difference(Json::parse(manifest_.head), head);
    if (!other.empty()) {
      throw Error{Fault::no_output,
                  folder + ": was captured with another setting (" + other + "); give another folder"};
    }
    require_images();
    if (manifest_.ended && manifest_.cut_bytes > 0) {
      warn(path + ": " + std::to_string(manifest_.cut_bytes) +
           " bytes of no whole line behind the end of the capture are cut off");
    }
    // What was being written when the capture before ended is no line.
    const std::string text = read_all(path);
    fs::resize_file(path, text.rfind('\n') + 1);
  }
  log_ = open(path.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0644);
  if (log_ < 0) throw system_error(Fault::no_output, path + ": cannot be written", errno);
  if (again) return;
  manifest_.sealed = true;  // one that was begun without seals stays so
  write_line(head);
}

CaptureFolder::~CaptureFolder() {
  if (log_ >= 0) close(log_);
}

// One that was deleted is to be captured again.
void CaptureFolder::require_images() {
  for (const auto& [place, record] : manifest_.frames) {
    if (!record.complete) continue;
    if (!has_regular_file((fs::path(folder_) / capture_file_name(place)).string())) {
      gone_.insert(place);
    } else {
      (void)read_captured(folder_, record);
      ++earlier_;
    }
  }
  unlisted_ = unlisted(manifest_, images_of(folder_));
  // A capture that was killed between the image and its line leaves one, which this one takes again.
  if (unlisted_.size() > 1) throw Error{Fault::data, without_line(folder_, unlisted_)};
}

bool CaptureFolder::has(long place) const {
  const auto found = manifest_.frames.find(place);
  return found != manifest_.frames.end() && found->second.complete && !gone_.contains(place);
}

void CaptureFolder::keep(CaptureRecord record, const GreyImage& levels) {
  const std::string name = capture_file_name(record.place);
  record.levels = fingerprint(levels);
  write_png((fs::path(folder_) / name).string(), levels);
  write_line(to_line(record));
  manifest_.frames[record.place] = record;
  gone_.erase(record.place);
  fresh_.insert(record.place);
  unlisted_.erase(name);
}

void CaptureFolder::dropped(long first, long last) {
  write_line({{"dropped", {first, last}}});
  manifest_.dropped += last - first + 1;
}

void CaptureFolder::end() {
  if (!manifest_.ended && manifest_.sealed) {
    write_line({{"frames", manifest_.frames.size()}, {"dropped_frames", manifest_.dropped}});
    manifest_.ended = true;
  }
  if (earlier_ > 0 && !fresh_.empty()) {
    warn(folder_ + ": keeps " + std::to_string(earlier_) + " images of an earlier capture; new are " +
         names_of(fresh_) + "; if the scene has changed since, capture all into another folder");
  }
  if (!unlisted_.empty()) throw Error{Fault::data, without_line(folder_, unlisted_)};
}

void CaptureFolder::write_line(Json line) {
  const Digest seal = manifest_seal(manifest_.seal, line);
  if (manifest_.sealed) line[manifest_seal_key] = seal_text(seal);
  write_synced(log_, line.dump() + "\n", manifest_path(folder_));
  manifest_.seal = seal;
  manifest_.ended = false;
}

}  // namespace vam::io
