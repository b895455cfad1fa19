// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/scratch_file.hpp"

#include <fcntl.h>
#include <stdlib.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cerrno>

#include "base/system_error.hpp"

namespace vam {

namespace {

[[noreturn]] void fail(Fault fault, const std::string& folder, const std::string& what, int problem) {
  throw system_error(fault, folder + ": " + what + " a scratch file for what does not fit into memory", problem,
                     "set TMPDIR to a folder on a disk with room");
}

// Where the file system knows no files without a name, one is created and removed at once.
int open_unnamed(const std::string& folder) {
  const int file = open(folder.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0600);
  if (file >= 0 || (errno != EOPNOTSUPP && errno != EISDIR)) return file;
  std::string name = folder + "/.vam-scratch-XXXXXX";
  const int named = mkostemp(name.data(), O_CLOEXEC);
  if (named >= 0) unlink(name.c_str());
  return named;
}

}  // namespace

ScratchFile::ScratchFile() {
  const char* chosen = getenv("TMPDIR");
  folder_ = chosen != nullptr && *chosen != '\0' ? chosen : "/var/tmp";
  descriptor_ = open_unnamed(folder_);
  if (descriptor_ < 0) fail(Fault::no_output, folder_, "cannot create", errno);
}

ScratchFile::~ScratchFile() { close(descriptor_); }

void ScratchFile::write(std::uint64_t offset, const void* bytes, std::size_t size) {
  const char* from = static_cast<const char*>(bytes);
  while (size > 0) {
    const ssize_t sent = pwrite(descriptor_, from, size, static_cast<off_t>(offset));
    if (sent < 0 && errno == EINTR) continue;
    if (sent < 0) fail(Fault::io, folder_, "cannot write", errno);
    from += sent;
    offset += static_cast<std::uint64_t>(sent);
    size -= static_cast<std::size_t>(sent);
  }
}

void ScratchFile::read(std::uint64_t offset, void* to, std::size_t size) const {
  char* into = static_cast<char*>(to);
  while (size > 0) {
    const ssize_t got = pread(descriptor_, into, size, static_cast<off_t>(offset));
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) fail(Fault::io, folder_, "cannot read", got < 0 ? errno : EIO);
    into += got;
    offset += static_cast<std::uint64_t>(got);
    size -= static_cast<std::size_t>(got);
  }
}

void* ScratchFile::map(std::size_t size) {
  // Without room a later write to the memory would end the process.
  const int full = posix_fallocate(descriptor_, 0, static_cast<off_t>(size));
  if (full != 0) fail(Fault::io, folder_, "cannot reserve " + std::to_string(size >> 20U) + " MiB of", full);
  void* memory = mmap(nullptr, size, PROT_READ | PROT_WRITE, MAP_SHARED, descriptor_, 0);
  if (memory == MAP_FAILED) fail(Fault::io, folder_, "cannot map", errno);
  return memory;
}

}  // namespace vam
