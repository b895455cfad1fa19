// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/array/private/npz.hpp"

#include <zip.h>

#include <algorithm>
#include <vector>

#include "base/error.hpp"
#include "base/text/printable.hpp"
#include "base/text/text.hpp"
#include "io/stream/zip_end.hpp"

namespace vam::io::arrays {

namespace {

constexpr std::string_view ending = ".npy";
constexpr zip_int64_t most_names = 1 << 16;

[[noreturn]] void damaged(const std::string& file) {
  throw Error{Fault::data, file + ": the .npz archive is truncated or damaged; save it again with numpy.savez()"};
}

// The names of its arrays, without the ending.
std::vector<std::string> names_of(zip* archive) {
  std::vector<std::string> names;
  const zip_int64_t count = std::min<zip_int64_t>(zip_get_num_entries(archive, 0), most_names);
  for (zip_int64_t i = 0; i < count; ++i) {
    const char* name = zip_get_name(archive, static_cast<zip_uint64_t>(i), 0);
    const std::string_view text = name == nullptr ? "" : name;
    if (text.ends_with(ending)) names.emplace_back(text.substr(0, text.size() - ending.size()));
  }
  return names;
}

void require_distinct(std::vector<std::string> names, const std::string& file) {
  std::sort(names.begin(), names.end());
  const auto twice = std::adjacent_find(names.begin(), names.end());
  if (twice == names.end()) return;
  throw Error{Fault::data, file + ": holds two arrays called " + excerpt(*twice) +
                               ", of which only one would be read; save it again with numpy.savez()"};
}

std::string chosen(const std::vector<std::string>& names, const std::string& name, const std::string& file) {
  if (names.empty()) throw Error{Fault::data, file + ": is a zip archive without an array (.npy)"};
  require_distinct(names, file);
  if (name.empty() && names.size() == 1) return names.front();
  if (std::find(names.begin(), names.end(), name) != names.end()) return name;
  constexpr std::size_t most = 8;
  std::vector<std::string> some;
  for (std::size_t i = 0; i < std::min(names.size(), most); ++i) some.push_back(briefly(names[i]));
  const std::string has = "holds " + std::to_string(names.size()) + " arrays (" + join(some, ", ") + ")";
  throw Error{Fault::usage,
              file + ": " + has + (name.empty() ? "; name one by --array" : ", but none is called " + printable(name))};
}

}  // namespace

void PackedArray::Close::operator()(zip* archive) const { zip_discard(archive); }
void PackedArray::Close::operator()(zip_file* file) const { zip_fclose(file); }

PackedArray::PackedArray(std::string_view bytes, const std::string& name, const std::string& file) : file_(file) {
  if (const std::uint64_t more = bytes_behind_zip(bytes); more > 0) {
    throw Error{Fault::data, file + ": trailing data after the end of the .npz archive, from byte " +
                                 std::to_string(bytes.size() - more) + " on; save it again with numpy.savez()"};
  }
  if (const std::uint64_t more = bytes_before_zip(bytes); more > 0) {
    throw Error{Fault::data, file + ": the .npz archive begins at byte " + std::to_string(more) +
                                 " only; save it again with numpy.savez()"};
  }
  zip_source_t* source = zip_source_buffer_create(bytes.data(), bytes.size(), 0, nullptr);
  if (source == nullptr) damaged(file);
  archive_.reset(zip_open_from_source(source, ZIP_RDONLY, nullptr));
  if (archive_ == nullptr) {
    zip_source_free(source);
    damaged(file);
  }
  const std::string entry = chosen(names_of(archive_.get()), name, file) + std::string(ending);
  zip_stat_t about;
  if (zip_stat(archive_.get(), entry.c_str(), 0, &about) != 0 || (about.valid & ZIP_STAT_SIZE) == 0) damaged(file);
  size_ = about.size;
  array_.reset(zip_fopen(archive_.get(), entry.c_str(), 0));
  if (array_ == nullptr) damaged(file);
}

void PackedArray::require(const Head& head) const {
  const std::uint64_t promised = head.values() * static_cast<std::uint64_t>(head.bytes);
  if (promised <= size_) return;
  throw Error{Fault::data, file_ + ": is cut off: its header promises " + std::to_string(promised) +
                               " bytes, but the archive has " + std::to_string(size_) +
                               "; the program that wrote it did not finish"};
}

std::size_t PackedArray::read(void* to, std::size_t size) {
  std::size_t done = 0;
  while (done < size) {
    const zip_int64_t got = zip_fread(array_.get(), static_cast<char*>(to) + done, size - done);
    if (got < 0) damaged(file_);
    if (got == 0) break;
    done += static_cast<std::size_t>(got);
  }
  return done;
}

}  // namespace vam::io::arrays
