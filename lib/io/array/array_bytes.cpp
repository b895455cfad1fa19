// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/array/private/array_bytes.hpp"

#include <zlib.h>

#include <algorithm>
#include <memory>
#include <stdexcept>
#include <utility>
#include <vector>

#include "base/error.hpp"

namespace vam::io::arrays {

namespace {

constexpr std::size_t piece = 1 << 16;

/// What comes packed from another reader: members of gzip, one behind the other, each with its checksum.
class Unpacked {
 public:
  Unpacked(Bytes::Read packed, std::string name) : packed_(std::move(packed)), name_(std::move(name)), in_(piece) {
    constexpr int gzip_only = 16 + MAX_WBITS;
    if (inflateInit2(&state_, gzip_only) != Z_OK) throw Error{Fault::bug, name_ + ": zlib does not start"};
  }
  ~Unpacked() { inflateEnd(&state_); }
  Unpacked(const Unpacked&) = delete;
  Unpacked& operator=(const Unpacked&) = delete;

  std::size_t read(void* to, std::size_t size) {
    std::size_t done = 0;
    while (done < size && (member_open_ || begin_member())) {
      const std::size_t step = std::min(size - done, piece);
      state_.next_out = static_cast<Bytef*>(to) + done;
      state_.avail_out = static_cast<uInt>(step);
      inflate_some();
      done += step - state_.avail_out;
    }
    return done;
  }

 private:
  bool has_more() {
    if (state_.avail_in > 0) return true;
    state_.next_in = in_.data();
    state_.avail_in = static_cast<uInt>(packed_(in_.data(), in_.size()));
    return state_.avail_in > 0;
  }

  // False at the end of the file.
  bool begin_member() {
    constexpr Bytef magic = 0x1f;
    if (!has_more()) return false;
    if (*state_.next_in != magic) fail("has bytes behind its gzip data; it is damaged, or several files in one");
    inflateReset(&state_);
    return member_open_ = true;
  }

  void inflate_some() {
    if (!has_more()) fail("is cut off before the end of its gzip data; the program that wrote it did not finish");
    const int status = inflate(&state_, Z_NO_FLUSH);
    if (status != Z_OK && status != Z_STREAM_END && status != Z_BUF_ERROR) {
      fail("its gzip data is damaged; write it again");
    }
    member_open_ = status != Z_STREAM_END;
  }

  [[noreturn]] void fail(const std::string& why) const { throw Error{Fault::data, name_ + ": " + why}; }

  Bytes::Read packed_;
  std::string name_;
  std::vector<Bytef> in_;
  z_stream state_{};
  bool member_open_ = true;
};

}  // namespace

Bytes::Bytes(Read read, std::string name) : read_(std::move(read)), name_(std::move(name)) {}

void Bytes::fail(const std::string& why) const { throw Error{Fault::data, name_ + ": " + why}; }

void Bytes::take(void* to, std::size_t size) {
  const std::size_t got = read_(to, size);
  taken_ += got;
  if (got == size) return;
  fail("is cut off after " + std::to_string(taken_) + " bytes; the program that wrote it did not finish");
}

std::string Bytes::line() {
  std::string text;
  for (char next = 0;;) {
    take(&next, 1);
    if (next == '\n') break;
    text += next;
    if (text.size() > piece) fail("its header is damaged: a line has more than 65536 characters");
  }
  if (text.ends_with('\r')) text.pop_back();
  return text;
}

void Bytes::skip(std::size_t size) {
  std::vector<char> dropped(std::min(size, piece));
  for (std::size_t done = 0; done < size; done += dropped.size()) {
    take(dropped.data(), std::min(dropped.size(), size - done));
  }
}

void Bytes::unpack() {
  auto unpacked = std::make_shared<Unpacked>(std::move(read_), name_);
  read_ = [unpacked](void* to, std::size_t size) { return unpacked->read(to, size); };
}

bool Bytes::ended() {
  char more = 0;
  return read_(&more, 1) == 0;
}

void set_shape(const Bytes& bytes, const std::vector<std::uint64_t>& shape, Head& head) {
  try {
    set_shape(shape, head);
  } catch (const std::runtime_error& problem) {
    bytes.fail(problem.what());
  }
}

}  // namespace vam::io::arrays
