// SPDX-License-Identifier: GPL-3.0-or-later
#include <fcntl.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>

#include "base/error.hpp"
#include "base/sha256.hpp"
#include "base/system_error.hpp"
#include "base/text/text.hpp"
#include "io/stream/private/temporary.hpp"
#include "io/stream/stream.hpp"

namespace vam::io {

namespace {

constexpr std::size_t read_bytes = std::size_t{1} << 20;

// /dev/zero, full, random and urandom, by the numbers that Linux gives them for good.
bool never_ends(const struct stat& about) {
  constexpr unsigned memory_devices = 1;
  constexpr std::array<unsigned, 4> endless{5, 7, 8, 9};
  return S_ISCHR(about.st_mode) && major(about.st_rdev) == memory_devices &&
         std::find(endless.begin(), endless.end(), minor(about.st_rdev)) != endless.end();
}

}  // namespace

void require_end(const struct stat& about, const std::string& name) {
  if (never_ends(about)) throw Error{Fault::no_input, name + ": is a device that never ends; name a file"};
}

InputFile::InputFile(const std::string& path, Content content) : name_(input_name(path)) {
  descriptor_ = path == "-" ? STDIN_FILENO : open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NOCTTY);
  struct stat about = {};
  if (descriptor_ < 0 || fstat(descriptor_, &about) != 0) {
    const int problem = errno;
    if (descriptor_ > STDIN_FILENO) close(descriptor_);
    throw system_error(Fault::no_input, name_ + ": cannot open", problem);
  }
  const bool terminal = isatty(descriptor_) == 1;
  if (S_ISDIR(about.st_mode) || never_ends(about) || (terminal && content == Content::binary)) {
    if (descriptor_ > STDIN_FILENO) close(descriptor_);
    require_end(about, name_);
    if (!terminal) throw Error{Fault::no_input, name_ + ": is a directory; name a file in it"};
    throw Error{Fault::usage, name_ + ": is a terminal and the input is binary; name a file or use a pipe"};
  }
  (void)fcntl(descriptor_, F_SETPIPE_SZ, pipe_bytes);  // fails on what is no pipe, and then does not matter
  (void)posix_fadvise(descriptor_, 0, 0, POSIX_FADV_SEQUENTIAL);
  if (S_ISREG(about.st_mode)) size_ = static_cast<std::uint64_t>(about.st_size);
  buffer_ = std::make_unique_for_overwrite<char[]>(read_bytes);
}

InputFile::~InputFile() {
  if (descriptor_ > STDIN_FILENO) close(descriptor_);
}

std::size_t InputFile::receive(char* to, std::size_t size) {
  while (true) {
    const ssize_t got = ::read(descriptor_, to, size);
    if (got >= 0) return static_cast<std::size_t>(got);
    if (errno != EINTR) throw Error{Fault::io, name_ + ": cannot read: " + std::strerror(errno)};
  }
}

std::span<const char> InputFile::peek() {
  if (begin_ == end_) {
    begin_ = 0;
    end_ = receive(buffer_.get(), read_bytes);
  }
  return {buffer_.get() + begin_, end_ - begin_};
}

void InputFile::skip(std::size_t size) {
  begin_ += size;
  position_ += size;
}

std::size_t InputFile::read(void* to, std::size_t size) {
  char* out = static_cast<char*>(to);
  std::size_t done = 0;
  while (done < size) {
    std::size_t step = 0;
    if (begin_ == end_ && size - done >= read_bytes) {  // no detour through the buffer
      step = receive(out + done, size - done);
      position_ += step;
    } else {
      const auto ready = peek();
      step = std::min(ready.size(), size - done);
      if (step > 0) std::memcpy(out + done, ready.data(), step);
      skip(step);
    }
    if (step == 0) break;
    done += step;
  }
  return done;
}

std::string read_all(const std::string& path, Content content, std::uint64_t limit) {
  InputFile file(path, content);
  return read_all(file, limit);
}

std::string read_all(InputFile& file, std::uint64_t limit) {
  std::string bytes;
  for (auto ready = file.peek(); !ready.empty(); ready = file.peek()) {
    if (std::max<std::uint64_t>(bytes.size() + ready.size(), file.size()) > limit) {
      throw Error{Fault::data, file.name() + ": longer than the limit of " +
                                   format_number(static_cast<double>(limit) / (1 << 20)) + " MiB"};
    }
    bytes.append(ready.data(), ready.size());
    file.skip(ready.size());
  }
  return bytes;
}

std::string sha256_of(const std::string& path) {
  InputFile file(path);
  Sha256 hash;
  for (auto bytes = file.peek(); !bytes.empty(); bytes = file.peek()) {
    hash.add(bytes.data(), bytes.size());
    file.skip(bytes.size());
  }
  return hash.digest();
}

}  // namespace vam::io
