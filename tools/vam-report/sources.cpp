// SPDX-License-Identifier: GPL-3.0-or-later
#include "vam-report/sources.hpp"

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <system_error>

#include "base/error.hpp"
#include "base/text/json.hpp"
#include "base/text/json_text.hpp"
#include "io/image/image_file.hpp"
#include "io/mesh/file.hpp"
#include "io/stream/file_type.hpp"
#include "io/stream/stream.hpp"

namespace vam::report_tool {

namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t most_text = std::uint64_t{16} << 20;

bool is_report(const std::string& path) {
  return parse_json(io::read_all(path, io::Content::text, most_text)).is_object();
}

bool is_trace(const std::string& path) {
  return io::read_all(path, io::Content::text, most_text).starts_with("iteration,");
}

bool is_png(const std::string& path) {
  return io::read_all(path, io::Content::binary, most_text).starts_with("\x89PNG\r\n\x1a\n");
}

bool is_mesh_ending(const std::string& ending) {
  constexpr std::array<const char*, 5> known{".ply", ".stl", ".off", ".obj", ".3mf"};
  return std::find(known.begin(), known.end(), ending) != known.end();
}

std::string beginning(const std::string& path) {
  std::string head(512, '\0');
  std::ifstream file(path, std::ios::binary);
  file.read(head.data(), static_cast<std::streamsize>(head.size()));
  head.resize(static_cast<std::size_t>(file.gcount()));
  return head;
}

/// False if a report cannot show the file.
bool add(Sources& sources, const std::string& path) {
  if (const auto type = io::known_file_type(path)) {
    switch (*type) {
      case io::FileType::volume:
        sources.volumes.push_back(path);
        return true;
      case io::FileType::stack:
        sources.stacks.push_back(path);
        return true;
      case io::FileType::video:
        sources.videos.push_back(path);
        return true;
      case io::FileType::images:
        return false;
    }
  }
  const std::string ending = fs::path(path).extension();
  if (ending == ".json" && is_report(path)) return sources.reports.push_back(path), true;
  if (ending == ".csv" && is_trace(path)) return sources.traces.push_back(path), true;
  if (is_mesh_ending(ending)) {
    (void)io::read_mesh(path);  // whole, or an error that names it
    return sources.meshes.push_back(path), true;
  }
  if (ending == ".png" && is_png(path)) {
    (void)io::read_image(path);  // whole, or an error that names it
    return sources.images.push_back(path), true;
  }
  return false;
}

void add_folder(Sources& sources, const std::string& folder) {
  std::vector<std::string> files;
  std::error_code problem;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, problem)) {
    if (entry.is_regular_file()) files.push_back(entry.path().string());
  }
  if (problem) throw Error{Fault::no_input, folder + ": " + problem.message()};
  std::sort(files.begin(), files.end());
  long shown = 0;
  for (const std::string& file : files) shown += add(sources, file) ? 1 : 0;
  if (shown == 0) {
    throw Error{Fault::data,
                folder + ": contains no volume, mesh, stack, video, report (JSON), trace (CSV) or image (PNG)"};
  }
}

}  // namespace

Sources gather(const std::vector<std::string>& paths) {
  Sources sources;
  for (const std::string& path : paths) {
    if (path == "-") throw Error{Fault::usage, "FILE: files are read more than once; give files instead of -"};
    if (fs::is_directory(path)) {
      add_folder(sources, path);
    } else if (!add(sources, path)) {
      const std::string head = beginning(path);
      const std::string foreign = head.starts_with('{') ? "" : io::foreign_format(head);  // JSON, but no report
      const std::string found = head.empty() ? "empty" : foreign;
      throw Error{Fault::data, path + (found.empty() ? ": is not" : ": is " + found + ", not") +
                                   " a volume, mesh, stack, video, report (JSON), trace (CSV of vam-optimize "
                                   "--trace) or image (PNG)"};
    }
  }
  return sources;
}

}  // namespace vam::report_tool
