// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/mesh/private/zip_archive.hpp"

#include <zip.h>

#include <algorithm>
#include <string>
#include <vector>

#include "base/text/printable.hpp"
#include "io/mesh/private/formats.hpp"
#include "io/stream/zip_end.hpp"

namespace vam::io {

namespace {

constexpr std::uint64_t most_unpacked = std::uint64_t{64} << 20;  // and as often what the archive has
constexpr std::uint64_t most_ratio = 64;
constexpr zip_flags_t name_flags = ZIP_FL_NOCASE;  // Open Packaging Conventions: names differ by more than case

[[noreturn]] void damaged(const std::string& what, zip_error_t* error) {
  std::string why = zip_error_strerror(error);
  zip_error_fini(error);
  throw MeshProblem{"not a whole 3MF file: " + what + " (" + why + "); it is truncated or damaged"};
}

std::vector<std::string> names_of(zip* archive) {
  std::vector<std::string> names;
  const zip_int64_t count = zip_get_num_entries(archive, 0);
  for (zip_int64_t i = 0; i < count; ++i) {
    const char* name = zip_get_name(archive, static_cast<zip_uint64_t>(i), 0);
    if (name != nullptr) names.push_back(lower_case(name));
  }
  return names;
}

void require_distinct(std::vector<std::string> names) {
  std::sort(names.begin(), names.end());
  const auto twice = std::adjacent_find(names.begin(), names.end());
  if (twice == names.end()) return;
  throw MeshProblem{"the 3MF archive holds two files called " + excerpt(*twice) +
                    ", of which only one would be read; save it again"};
}

struct CloseZipFile {
  void operator()(zip_file_t* file) const { zip_fclose(file); }
};

}  // namespace

void ZipArchive::Close::operator()(zip* archive) const { zip_discard(archive); }

ZipArchive::ZipArchive(std::string_view bytes) : left_(most_unpacked + most_ratio * bytes.size()) {
  if (const std::uint64_t more = bytes_behind_zip(bytes); more > 0) {
    throw MeshProblem{"trailing data after the end of the 3MF archive, from byte " +
                      std::to_string(bytes.size() - more) + " on; save it again"};
  }
  if (const std::uint64_t more = bytes_before_zip(bytes); more > 0)
    throw MeshProblem{"the 3MF archive begins at byte " + std::to_string(more) + " only; save it again"};
  zip_error_t error;
  zip_error_init(&error);
  zip_source_t* source = zip_source_buffer_create(bytes.data(), bytes.size(), 0, &error);
  if (source == nullptr) damaged("no zip archive", &error);
  archive_.reset(zip_open_from_source(source, ZIP_RDONLY, &error));
  if (archive_ == nullptr) {
    zip_source_free(source);
    damaged("no zip archive", &error);
  }
  require_distinct(names_of(archive_.get()));
}

bool ZipArchive::has(const std::string& name) const {
  return zip_name_locate(archive_.get(), name.c_str(), name_flags) >= 0;
}

std::string ZipArchive::first_with(std::string_view suffix) const {
  const zip_int64_t count = zip_get_num_entries(archive_.get(), 0);
  for (zip_int64_t i = 0; i < count; ++i) {
    const char* name = zip_get_name(archive_.get(), static_cast<zip_uint64_t>(i), 0);
    if (name != nullptr && std::string_view(name).ends_with(suffix)) return name;
  }
  return "";
}

void ZipArchive::read(const std::string& name, const std::function<void(std::string_view)>& take) {
  const std::unique_ptr<zip_file_t, CloseZipFile> file(zip_fopen(archive_.get(), name.c_str(), name_flags));
  if (file == nullptr) damaged(name, zip_get_error(archive_.get()));
  std::vector<char> piece(std::size_t{1} << 16);
  zip_int64_t got = 0;
  while ((got = zip_fread(file.get(), piece.data(), piece.size())) > 0) {
    const auto size = static_cast<std::size_t>(got);
    if (size > left_) {
      throw MeshProblem{"unpacks to more than 64 MiB and 64 times its size; it is damaged, or save it as STL"};
    }
    left_ -= size;
    take({piece.data(), size});
  }
  if (got < 0) damaged(name, zip_file_get_error(file.get()));
}

}  // namespace vam::io
