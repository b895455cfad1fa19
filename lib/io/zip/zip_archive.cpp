// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/zip/zip_archive.hpp"

#include <zip.h>

#include <algorithm>
#include <cctype>
#include <stdexcept>
#include <utility>

#include "base/text/printable.hpp"

namespace vam::io {

namespace {

struct Margins {
  std::uint64_t before = 0;
  std::uint64_t behind = 0;
};

/// Bytes around the archive, by its end record and comment (PKWARE APPNOTE section 4.3.16). libzip looks for that in
/// the last bytes of a file, and for all else from there.
Margins margins_of(std::string_view bytes) {
  constexpr std::string_view mark = "PK\5\6";
  constexpr std::size_t record = 22, size_at = 12, start_at = 16, length_at = 20, most_comment = 0xffff;
  const auto number = [bytes](std::size_t at, int count) {
    std::uint64_t value = 0;
    while (count-- > 0) value = value << 8 | static_cast<unsigned char>(bytes[at + static_cast<std::size_t>(count)]);
    return value;
  };
  const std::size_t first = bytes.size() - std::min(bytes.size(), 2 * (record + most_comment));
  Margins margins;
  for (std::size_t at = bytes.rfind(mark); at != bytes.npos && at >= first; at = bytes.rfind(mark, at - 1)) {
    const std::uint64_t end = bytes.size() - at < record ? 0 : at + record + number(at + length_at, 2);
    if (end == bytes.size()) {  // what looks like one may stand in a comment
      const std::uint64_t start = number(at + start_at, 4), size = number(at + size_at, 4) + start;
      return {start == 0xffffffff || size > at ? 0 : at - size, 0};  // of ZIP64 the start is elsewhere
    }
    if (end > 0 && end < bytes.size() && margins.behind == 0) margins.behind = bytes.size() - end;
    if (at == 0) break;
  }
  return margins;
}

std::string lower_case(std::string text) {
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

}  // namespace

void ZipArchive::Close::operator()(zip* archive) const { zip_discard(archive); }
void ZipArchive::Close::operator()(zip_file* file) const { zip_fclose(file); }

void ZipArchive::damaged(const std::string& why) const {
  throw std::runtime_error("the " + kind_ + " archive is truncated or damaged (" + why + "); save it again");
}

ZipArchive::ZipArchive(std::string_view bytes, std::string kind, bool no_case)
    : kind_(std::move(kind)), flags_(no_case ? ZIP_FL_NOCASE : 0) {
  const Margins margins = margins_of(bytes);
  if (margins.behind > 0) {
    throw std::runtime_error("trailing data after the end of the " + kind_ + " archive, from byte " +
                             std::to_string(bytes.size() - margins.behind) + " on; save it again");
  }
  if (margins.before > 0) {
    throw std::runtime_error("the " + kind_ + " archive begins at byte " + std::to_string(margins.before) +
                             " only; save it again");
  }
  zip_source_t* source = zip_source_buffer_create(bytes.data(), bytes.size(), 0, nullptr);
  if (source == nullptr) damaged("no memory");
  archive_.reset(zip_open_from_source(source, ZIP_RDONLY, nullptr));
  if (archive_ == nullptr) {
    zip_source_free(source);
    damaged("no list of its files");
  }
  const zip_int64_t count = zip_get_num_entries(archive_.get(), 0);
  std::vector<std::string> same;
  for (zip_int64_t i = 0; i < count; ++i) {
    const char* name = zip_get_name(archive_.get(), static_cast<zip_uint64_t>(i), 0);
    if (name == nullptr) continue;
    names_.emplace_back(name);
    same.push_back(no_case ? lower_case(name) : name);
  }
  std::sort(same.begin(), same.end());
  const auto twice = std::adjacent_find(same.begin(), same.end());
  if (twice == same.end()) return;
  throw std::runtime_error("the " + kind_ + " archive holds two files called " + excerpt(*twice) +
                           ", of which only one would be read; save it again");
}

bool ZipArchive::has(const std::string& name) const {
  return zip_name_locate(archive_.get(), name.c_str(), flags_) >= 0;
}

std::uint64_t ZipArchive::open(const std::string& name) {
  zip_stat_t about;
  file_.reset(zip_fopen(archive_.get(), name.c_str(), flags_));
  if (file_ == nullptr || zip_stat(archive_.get(), name.c_str(), flags_, &about) != 0 ||
      (about.valid & ZIP_STAT_SIZE) == 0) {
    damaged(printable(name) + ": " + zip_strerror(archive_.get()));
  }
  return about.size;
}

std::size_t ZipArchive::read(void* to, std::size_t size) {
  std::size_t done = 0;
  while (done < size) {
    const zip_int64_t got = zip_fread(file_.get(), static_cast<char*>(to) + done, size - done);
    if (got < 0) damaged(zip_file_strerror(file_.get()));
    if (got == 0) break;
    done += static_cast<std::size_t>(got);
  }
  return done;
}

}  // namespace vam::io
