// SPDX-License-Identifier: GPL-3.0-or-later
// What the targets share. An Error is an answer; all else that comes out of a parser, and every signal, is a find.
#pragma once

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <array>
#include <cstdint>
#include <cstdlib>
#include <exception>
#include <string>

#include "base/error.hpp"

namespace fuzz {

/// Bytes at a path that ends with this object.
class Source {
 public:
  ~Source() { close(descriptor_); }
  Source(const Source&) = delete;
  Source& operator=(const Source&) = delete;
  const std::string path;

 protected:
  explicit Source(int descriptor) : path("/proc/self/fd/" + std::to_string(descriptor)), descriptor_(descriptor) {}
  static void fill(int descriptor, const std::string& bytes) {
    if (descriptor < 0 || ::write(descriptor, bytes.data(), bytes.size()) != static_cast<ssize_t>(bytes.size()))
      abort();
  }

 private:
  int descriptor_;
};

/// The bytes as a file that has a path but no name.
class File : public Source {
 public:
  explicit File(const std::string& bytes) : Source(made(bytes)) {}

 private:
  static int made(const std::string& bytes) {
    const int descriptor = memfd_create("fuzz", MFD_CLOEXEC);
    fill(descriptor, bytes);
    return descriptor;
  }
};

/// The bytes as a pipe that has been written to the end.
class Pipe : public Source {
 public:
  static constexpr std::size_t room = std::size_t{1} << 20;
  explicit Pipe(const std::string& bytes) : Source(made(bytes)) {}

 private:
  static int made(const std::string& bytes) {
    std::array<int, 2> ends{};
    if (pipe2(ends.data(), O_CLOEXEC) != 0 || fcntl(ends[1], F_SETPIPE_SZ, room) < 0) abort();
    fill(ends[1], bytes);
    close(ends[1]);
    return ends[0];
  }
};

/// work() may succeed, or throw an Error that is the input's.
template <class Work>
int attempt(const Work& work) {
  try {
    work();
  } catch (const vam::Error& error) {
    if (error.fault == vam::Fault::bug) abort();
  }
  return 0;
}

/// The same in the child that parses a file, whose answers are a library's exceptions, too, as of bounds of memory.
template <class Work>
int attempt_in_child(const Work& work) {
  try {
    return attempt(work);
  } catch (const std::exception&) {
    return 0;
  }
}

inline std::string text_of(const std::uint8_t* bytes, std::size_t size) {
  return {reinterpret_cast<const char*>(bytes), size};
}

}  // namespace fuzz

/// libFuzzer calls it with every input.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size);
