// SPDX-License-Identifier: GPL-3.0-or-later
#include <openvdb/openvdb.h>
#include <openvdb/version.h>

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <iostream>
#include <stdexcept>
#include <string>
#include <string_view>

#include "io/stream/file_type.hpp"
#include "io/stream/stream_buffers.hpp"
#include "io/vdb/private/serialisation.hpp"

namespace vam::io {

namespace {

constexpr std::size_t max_name_bytes = 4096;
constexpr std::size_t max_value_bytes = std::size_t{1} << 26;  // a table of leaf sizes can be some MB
constexpr std::int32_t max_count = 1 << 16;                    // of grids, of metadata
constexpr std::size_t uuid_bytes = 36;

// Moves through the bytes; past their end every size is 0 and nothing is judged any more.
class Walk {
 public:
  explicit Walk(std::span<const char> bytes) : bytes_(bytes) {}

  template <class Number>
  Number number() {
    Number value{};
    if (sizeof value <= left()) std::memcpy(&value, bytes_.data() + at_, sizeof value);
    at_ += sizeof value;
    return value;
  }
  void skip(std::size_t size) { at_ += size; }
  void sized(std::size_t limit) {
    const auto size = number<std::uint32_t>();
    if (size > limit) {
      throw std::runtime_error("is damaged: byte " + std::to_string(at_) + " requires " + std::to_string(size) +
                               " bytes");
    }
    skip(size);
  }
  std::int32_t count() {
    const auto value = number<std::int32_t>();
    if (value < 0 || value > max_count) {
      throw std::runtime_error("is damaged: byte " + std::to_string(at_) + " counts " + std::to_string(value));
    }
    return value;
  }
  void metadata() {
    for (std::int32_t i = count(); i > 0 && left() > 0; --i) {
      sized(max_name_bytes);   // name
      sized(max_name_bytes);   // type
      sized(max_value_bytes);  // value
    }
  }
  [[nodiscard]] std::size_t left() const { return at_ < bytes_.size() ? bytes_.size() - at_ : 0; }

 private:
  std::span<const char> bytes_;
  std::size_t at_ = 0;
};

}  // namespace

bool is_archive(std::span<const char> bytes) { return Walk(bytes).number<std::int64_t>() == openvdb::OPENVDB_MAGIC; }

void check_head(std::span<const char> bytes) {
  Walk walk(bytes);
  if (walk.number<std::int64_t>() != openvdb::OPENVDB_MAGIC) {
    const std::string_view head{bytes.data(), bytes.size()};
    const std::string foreign = foreign_format(head);
    throw std::runtime_error((foreign.empty() ? "is not" : "is " + foreign + ", not") +
                             std::string(" an OpenVDB file (vam-slice makes one of a mesh, vam-dose of projections)") +
                             foreign_remedy(head));
  }
  const auto format = walk.number<std::uint32_t>();
  if (format > openvdb::OPENVDB_FILE_VERSION) {
    throw std::runtime_error("is of VDB format " + std::to_string(format) + ", but " +
                             std::to_string(openvdb::OPENVDB_FILE_VERSION) + " is the newest that can be read");
  }
  if (format < openvdb::OPENVDB_FILE_VERSION_NODE_MASK_COMPRESSION) return;  // before 2013; the head looked different
  walk.skip(2 * sizeof(std::uint32_t) + 1 + uuid_bytes);                     // library version, has-offsets, UUID
  walk.metadata();
  if (walk.count() == 0) return;
  for (int name = 0; name < 3; ++name) walk.sized(max_name_bytes);  // of the grid, its type, its parent
  walk.skip(3 * sizeof(std::int64_t) + sizeof(std::uint32_t));      // offsets, compression
  walk.metadata();
  walk.sized(max_name_bytes);  // of the transform
}

namespace {

// OpenVDB comments on std::cerr on what it meets in a damaged file; one line is enough, and it will be ours.
struct SilencedCerr {
  SilencedCerr() : saved(std::cerr.rdbuf(nullptr)) {}
  ~SilencedCerr() {
    std::cerr.rdbuf(saved);
    std::cerr.clear();
  }
  SilencedCerr(const SilencedCerr&) = delete;
  SilencedCerr& operator=(const SilencedCerr&) = delete;
  std::streambuf* saved;
};

}  // namespace

void for_archives(InputFile& file, const std::function<void(std::istream&)>& archive) {
  openvdb::initialize();  // grid and metadata types must be registered before anything is read
  try {
    if (file.at_end()) throw std::runtime_error("is empty; the program that should have written it failed");
    for (const std::uint64_t begin = file.position(); !file.at_end();) {
      if (file.position() > begin && !is_archive(file.peek())) {
        throw std::runtime_error("trailing data after the last grid, from byte " + std::to_string(file.position()) +
                                 " on, is not a volume; write the file again, or truncate it there");
      }
      check_head(file.peek());
      const SilencedCerr quiet;
      InputBuffer buffer(file);
      std::istream stream(&buffer);
      stream.exceptions(std::ios_base::badbit | std::ios_base::failbit);
      archive(stream);
    }
  } catch (const std::ios_base::failure&) {
    throw std::runtime_error("is cut off after " + std::to_string(file.position()) +
                             " bytes; the program that wrote it did not finish");
  } catch (const openvdb::ArithmeticError&) {
    throw std::runtime_error(
        "a grid has a transform with a number that is not finite, or without an inverse; mend it in the program that "
        "wrote it");
  }
}

}  // namespace vam::io
