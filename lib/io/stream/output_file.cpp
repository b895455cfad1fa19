// SPDX-License-Identifier: GPL-3.0-or-later
#include <fcntl.h>
#include <sys/stat.h>
#include <sys/statvfs.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <climits>
#include <cstdlib>

#include "base/compute/memory.hpp"
#include "base/error.hpp"
#include "base/system_error.hpp"
#include "io/stream/private/temporary.hpp"
#include "io/stream/stream.hpp"

namespace vam::io {

namespace {

constexpr std::size_t gathered_bytes = std::size_t{1}
                                       << 18;  // small writes are gathered up to here, larger ones go through

[[noreturn]] void fail(Fault fault, const std::string& name, const std::string& what, int problem) {
  throw system_error(fault, name + ": " + what, problem);
}

// Links are followed, so that the file is replaced and not the link that names it. An absent file keeps its path.
std::string followed(const std::string& path) {
  struct stat about = {};
  if (lstat(path.c_str(), &about) != 0 || !S_ISLNK(about.st_mode)) return path;
  std::array<char, PATH_MAX> real{};
  if (realpath(path.c_str(), real.data()) != nullptr) return real.data();
  // The link dangles: what it points to is to be created.
  const ssize_t length = readlink(path.c_str(), real.data(), real.size());
  if (length <= 0) return path;
  const std::string to(real.data(), length);
  return to.front() == '/' ? to : path.substr(0, path.rfind('/') + 1) + to;
}

// /dev/stdout and /dev/fd/N may lead to a regular file that somebody else holds open: it is written, not replaced.
bool is_descriptor_path(const std::string& path) { return path.starts_with("/dev/") || path.starts_with("/proc/"); }

}  // namespace

OutputFile::OutputFile(const std::string& path, Content content, Temporary temporary) : name_(path) {
  struct stat about = {};
  if (path == "-") {
    name_ = "stdout";
    descriptor_ = STDOUT_FILENO;
    if (fcntl(descriptor_, F_GETFL) < 0) fail(Fault::io, name_, "cannot write", errno);
  } else if (const bool exists = stat(path.c_str(), &about) == 0; exists && S_ISDIR(about.st_mode)) {
    throw Error{Fault::no_output, path + ": is a directory; name a file in it"};
  } else if (exists && (!S_ISREG(about.st_mode) || is_descriptor_path(path))) {
    open_special(path);
  } else {
    // A rename would replace even a write-protected file, which surely is not what its owner meant.
    if (exists && access(path.c_str(), W_OK) != 0) fail(Fault::no_output, path, "cannot write", errno);
    target_ = followed(path);
    if (temporary == Temporary::unnamed && access("/proc/self/fd", X_OK) == 0) {
      const auto slash = target_.rfind('/');
      const std::string directory = slash == std::string::npos ? "." : target_.substr(0, slash + 1);
      descriptor_ = open(directory.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0666);
    }
    if (descriptor_ < 0) descriptor_ = create_temporary(target_, temporary_, slot_);  // also where O_TMPFILE is unknown
    if (descriptor_ < 0) fail(Fault::no_output, path, "cannot create", errno);
    if (exists && fchmod(descriptor_, about.st_mode & 07777) != 0) errno = 0;  // kept where it can be
  }
  if (is_stream()) {
    if (content == Content::binary && isatty(descriptor_) == 1) {
      discard();
      throw Error{Fault::usage, name_ + ": is a terminal and the output is binary; use -o FILE or a pipe"};
    }
    (void)fcntl(descriptor_, F_SETPIPE_SZ, pipe_bytes);  // fails on what is no pipe, and then does not matter
  }
  buffer_.reserve(gathered_bytes);
}

OutputFile::~OutputFile() { discard(); }

void OutputFile::open_special(const std::string& path) {
  descriptor_ = open(path.c_str(), O_WRONLY | O_CLOEXEC | O_NOCTTY | O_TRUNC);
  if (descriptor_ < 0) fail(Fault::no_output, path, "cannot write", errno);
}

void OutputFile::require_space(double bytes) const {
  struct statvfs disk = {};
  if (is_stream() || fstatvfs(descriptor_, &disk) != 0) return;
  const double space = static_cast<double>(disk.f_bavail) * static_cast<double>(disk.f_frsize);
  if (bytes <= space) return;
  throw Error{Fault::io, name_ + ": needs " + in_gib(bytes) + ", but its file system has " + in_gib(space) +
                             " free; make room, or write to another"};
}

void OutputFile::write(const void* bytes, std::size_t size) {
  const char* from = static_cast<const char*>(bytes);
  if (buffer_.size() + size > gathered_bytes) flush();
  if (size >= gathered_bytes) {
    send(from, size);
  } else {
    buffer_.append(from, size);
  }
  position_ += size;
}

void OutputFile::send(const char* bytes, std::size_t size, std::optional<std::uint64_t> offset) {
  while (size > 0) {
    const ssize_t sent =
        offset ? pwrite(descriptor_, bytes, size, static_cast<off_t>(*offset)) : ::write(descriptor_, bytes, size);
    if (sent < 0 && errno == EINTR) continue;
    if (sent < 0) fail(Fault::io, name_, "cannot write", errno);
    if (offset) *offset += static_cast<std::uint64_t>(sent);
    bytes += sent;
    size -= static_cast<std::size_t>(sent);
  }
}

void OutputFile::flush() {
  send(buffer_.data(), buffer_.size());
  buffer_.clear();
}

void OutputFile::write_at(std::uint64_t offset, const void* bytes, std::size_t size) {
  flush();
  send(static_cast<const char*>(bytes), size, offset);
}

void OutputFile::commit() {
  flush();
  if (!is_stream()) publish();
  const int descriptor = descriptor_;
  descriptor_ = -1;
  // stdout stays open for the next writer. Network file systems report a full disk only on close.
  if (descriptor != STDOUT_FILENO && close(descriptor) != 0) fail(Fault::io, name_, "cannot finish", errno);
}

void OutputFile::publish() {
  // Without the wait a crash could leave the new name on an empty file.
  if (fsync(descriptor_) != 0 && errno != EINVAL && errno != EROFS) fail(Fault::io, name_, "cannot finish", errno);
  give_name();
  synchronise_folder_of(target_);
}

void OutputFile::give_name() {
  if (temporary_.empty()) {
    sweep_folder_of(target_);
    const std::string self = "/proc/self/fd/" + std::to_string(descriptor_);
    if (linkat(AT_FDCWD, self.c_str(), AT_FDCWD, target_.c_str(), AT_SYMLINK_FOLLOW) == 0) return;
    if (errno != EEXIST) fail(Fault::no_output, name_, "cannot create", errno);
    // linkat does not replace, rename does: the name in between lives for a moment only.
    if (name_temporary(descriptor_, target_, temporary_, slot_) != 0) {
      fail(Fault::no_output, name_, "cannot create", errno);
    }
  }
  if (rename(temporary_.c_str(), target_.c_str()) != 0) fail(Fault::no_output, name_, "cannot create", errno);
  forget_temporary(slot_);
  slot_ = -1;
  temporary_.clear();
}

void OutputFile::discard() noexcept {
  if (!temporary_.empty()) unlink(temporary_.c_str());
  forget_temporary(slot_);
  temporary_.clear();
  slot_ = -1;
  if (descriptor_ > STDOUT_FILENO) close(descriptor_);
  descriptor_ = -1;
}

void write_text(const std::string& path, std::string_view text) {
  OutputFile out(path, Content::text);
  out.write(text);
  out.commit();
}

}  // namespace vam::io
