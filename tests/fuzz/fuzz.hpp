// What the targets share. An Error is an answer; all else that comes out of a parser, and every signal, is a find.
#pragma once

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <array>
#include <cstdint>
#include <cstdlib>
#include <string>

#include "base/error.hpp"

namespace fuzz {

/// The bytes as a file that has a path but no name.
class File {
 public:
  explicit File(const std::string& bytes) : descriptor_(memfd_create("fuzz", MFD_CLOEXEC)) {
    if (descriptor_ < 0 || ::write(descriptor_, bytes.data(), bytes.size()) != static_cast<ssize_t>(bytes.size()))
      abort();
    path = "/proc/self/fd/" + std::to_string(descriptor_);
  }
  ~File() { close(descriptor_); }
  File(const File&) = delete;
  File& operator=(const File&) = delete;
  std::string path;

 private:
  int descriptor_;
};

/// The bytes as a pipe that has been written to the end.
class Pipe {
 public:
  static constexpr std::size_t room = std::size_t{1} << 20;
  explicit Pipe(const std::string& bytes) {
    std::array<int, 2> ends{};
    if (pipe2(ends.data(), O_CLOEXEC) != 0 || fcntl(ends[1], F_SETPIPE_SZ, room) < 0) abort();
    if (::write(ends[1], bytes.data(), bytes.size()) != static_cast<ssize_t>(bytes.size())) abort();
    close(ends[1]);
    descriptor_ = ends[0];
    path = "/proc/self/fd/" + std::to_string(descriptor_);
  }
  ~Pipe() { close(descriptor_); }
  Pipe(const Pipe&) = delete;
  Pipe& operator=(const Pipe&) = delete;
  std::string path;

 private:
  int descriptor_;
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

inline std::string text_of(const std::uint8_t* bytes, std::size_t size) {
  return {reinterpret_cast<const char*>(bytes), size};
}

}  // namespace fuzz

/// libFuzzer calls it with every input.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size);
