// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/image/capture_folder.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>

#include "base/error.hpp"
#include "base/json.hpp"
#include "base/json_text.hpp"
#include "base/system_error.hpp"
#include "io/image/image_file.hpp"
#include "io/stream/log_lines.hpp"
#include "io/stream/stream.hpp"

namespace vam::io {

namespace {

namespace fs = std::filesystem;

constexpr const char* manifest_name = "manifest.jsonl";

std::string manifest_path(const std::string& folder) { return (fs::path(folder) / manifest_name).string(); }

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

std::optional<double> optional_number(const Json& line, const char* key) {
  const auto found = line.find(key);
  if (found == line.end() || !found->is_number()) return std::nullopt;
  return found->get<double>();
}

// Of a frame. `where` begins the message.
long number_of(const Json& value, const std::string& where) {
  constexpr long most = 1L << 48;
  const long number = value.is_number_integer() ? value.get<long>() : most + 1;
  if (number >= -most && number <= most) return number;
  throw Error{Fault::data, where + ": " + value.dump() + " is not the number of a frame; remove the line"};
}

CaptureRecord to_record(const Json& line, const std::string& where) {
  CaptureRecord record;
  record.place = number_of(line.at("frame"), where);
  record.number = number_of(line.at("number"), where);
  record.t_monotonic_s = line.at("t_monotonic_s").get<double>();
  record.time_sigma_s = optional_number(line, "time_sigma_s");
  record.device_s = optional_number(line, "device_s");
  record.angle_deg = optional_number(line, "angle_deg");
  record.sigma_deg = optional_number(line, "sigma_deg");
  record.complete = line.at("complete").get<bool>();
  record.levels = line.at("levels").get<std::string>();
  return record;
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
    if (found == there.end() || *found != value) {
      return key + " " + (found == there.end() ? "unknown" : found->dump()) + ", not " + value.dump();
    }
  }
  return "";
}

void add_line(CaptureManifest& manifest, const std::string& text, const std::string& where) {
  const Json line = parse_json(text);
  try {
    if (manifest.head.empty()) {
      manifest.head = text;
      if (line.at("schema") != "vam-capture/1") throw Error{Fault::data, where + ": is not a manifest of vam-capture"};
    } else if (line.contains("dropped")) {
      const Json& range = line.at("dropped");
      manifest.dropped += number_of(range.at(1), where) - number_of(range.at(0), where) + 1;
    } else {
      const CaptureRecord record = to_record(line, where);
      const auto [there, fresh] = manifest.frames.try_emplace(record.place, record);
      if (!fresh && (record.complete || !there->second.complete)) there->second = record;
    }
  } catch (const Json::exception& problem) {
    throw Error{Fault::data, where + ": is not a line of a manifest (" + problem.what() + ")"};
  }
}

}  // namespace

std::string capture_file_name(long place) {
  std::array<char, 32> name{};
  std::snprintf(name.data(), name.size(), "%06ld.png", place);
  return name.data();
}

bool is_capture_folder(const std::string& folder) { return has_regular_file(manifest_path(folder)); }

CaptureManifest read_manifest(const std::string& folder) {
  const std::string path = manifest_path(folder);
  constexpr std::uint64_t most_bytes = std::uint64_t{256} << 20U;  // a million frames
  const std::string text = read_all(path, Content::text, most_bytes);
  CaptureManifest manifest;
  long number = 0;
  for (std::size_t begin = 0, end = 0; (end = text.find('\n', begin)) != std::string::npos; begin = end + 1) {
    add_line(manifest, text.substr(begin, end - begin), path + ": line " + std::to_string(++number));
  }
  if (manifest.head.empty()) throw Error{Fault::data, path + ": is empty; remove the folder and begin again"};
  return manifest;
}

CaptureFolder::CaptureFolder(const std::string& folder, const Json& head) : folder_(folder) {
  std::error_code problem;
  fs::create_directories(folder, problem);
  if (problem || !fs::is_directory(folder)) {
    throw Error{Fault::no_output, folder + ": cannot make the folder (" + problem.message() + ")"};
  }
  const std::string path = manifest_path(folder);
  const bool there = has_regular_file(path);
  const bool again = there && fs::file_size(path) > 0;
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
    // What was being written when the capture before ended is no line.
    const std::string text = read_all(path);
    fs::resize_file(path, text.rfind('\n') + 1);
  }
  directory_ = open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  log_ = open(path.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0644);
  if (directory_ < 0 || log_ < 0) {
    throw system_error(Fault::no_output, path + ": cannot be written", errno);
  }
  if (!again) write_line(head);
}

CaptureFolder::~CaptureFolder() {
  if (directory_ >= 0) close(directory_);
  if (log_ >= 0) close(log_);
}

bool CaptureFolder::has(long place) const {
  const auto found = manifest_.frames.find(place);
  return found != manifest_.frames.end() && found->second.complete;
}

void CaptureFolder::keep(const CaptureRecord& record, const GreyImage& levels) {
  const std::string name = capture_file_name(record.place);
  const std::string path = (fs::path(folder_) / name).string();
  const int file = openat(directory_, name.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
  if (file < 0) throw failed(path);
  try {
    write_synced(file, encode_png(levels), path);
  } catch (...) {
    close(file);
    throw;
  }
  close(file);
  if (fsync(directory_) != 0 && errno != EINVAL) throw failed(folder_);
  write_line(to_line(record));
  manifest_.frames[record.place] = record;
}

void CaptureFolder::dropped(long first, long last) { write_line({{"dropped", {first, last}}}); }

void CaptureFolder::write_line(const Json& line) { write_synced(log_, line.dump() + "\n", manifest_path(folder_)); }

}  // namespace vam::io
