// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/stream/file_type.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <filesystem>
#include <fstream>

#include "base/error.hpp"
#include "base/system_error.hpp"
#include "io/stream/input_name.hpp"
#include "io/stream/private/endless.hpp"
#include "io/stream/signature.hpp"

namespace vam::io {

namespace {

constexpr std::size_t look = 1024;  // for the names of foreign files
constexpr std::size_t enough = 16;  // for those that are read

// tee(2) copies what waits in one pipe into another and leaves it where it is.
std::string pipe_head(int descriptor) {
  std::array<int, 2> copy{};
  if (pipe2(copy.data(), O_CLOEXEC) != 0) return "";
  std::string head;
  // A writer may deliver its first bytes one by one; they are examined again until they suffice or the input ends.
  for (int attempt = 0; attempt < 1000 && head.size() < enough; ++attempt) {
    const ssize_t copied = tee(descriptor, copy[1], look, 0);
    if (copied <= 0) break;
    head.resize(copied);
    if (read(copy[0], head.data(), head.size()) != copied) break;
    if (head.size() < enough) poll(nullptr, 0, 1);
  }
  close(copy[0]);
  close(copy[1]);
  return head;
}

std::string stdin_head() {
  struct stat about {};
  if (fstat(STDIN_FILENO, &about) != 0) return "";
  require_end(about, input_name("-"));
  if (S_ISFIFO(about.st_mode)) return pipe_head(STDIN_FILENO);
  std::string head(look, '\0');
  const off_t here = lseek(STDIN_FILENO, 0, SEEK_CUR);
  const ssize_t count = here < 0 ? 0 : pread(STDIN_FILENO, head.data(), look, here);
  head.resize(count > 0 ? static_cast<std::size_t>(count) : 0);
  return head;
}

std::string file_head(const std::string& path) {
  struct stat about {};
  if (stat(path.c_str(), &about) == 0 && !S_ISREG(about.st_mode)) {  // a look would take its bytes
    require_end(about, path);
    throw Error{Fault::no_input, path + ": is not a regular file; give it on standard input"};
  }
  std::ifstream stream(path, std::ios::binary);
  if (!stream) throw system_error(Fault::no_input, path + ": cannot open", errno);
  std::string head(look, '\0');
  stream.read(head.data(), static_cast<std::streamsize>(look));
  head.resize(stream.gcount());
  return head;
}

std::string head_of(const std::string& path) { return path == "-" ? stdin_head() : file_head(path); }

// A 64-bit number begins with these four bytes.
bool begins_a_volume(const std::string& head) { return head.starts_with(" BDV"); }

}  // namespace

bool is_volume(const std::string& path) { return begins_a_volume(head_of(path)); }

bool is_lone_array(const std::string& path) {
  const std::string head = head_of(path);
  return head.starts_with("\x93NUMPY") || head.starts_with("NRRD") || head.starts_with("II") || head.starts_with("MM");
}

std::optional<FileType> known_file_type(const std::string& path) {
  std::error_code ignored;
  if (path != "-" && std::filesystem::is_directory(path, ignored)) return FileType::images;
  const std::string head = head_of(path);
  if (begins_a_volume(head)) return FileType::volume;
  if (head.starts_with("\x76\x2f\x31\x01")) return FileType::stack;
  if (head.starts_with("\x1a\x45\xdf\xa3") || (head.size() >= 8 && head.substr(4, 4) == "ftyp")) return FileType::video;
  return std::nullopt;
}

void require_content(const std::string& path) {
  std::error_code ignored;
  if ((path != "-" && std::filesystem::is_directory(path, ignored)) || !head_of(path).empty()) return;
  throw Error{Fault::data, input_name(path) + ": is empty; the program that should have written it failed"};
}

FileType file_type(const std::string& path) {
  if (const auto known = known_file_type(path)) return *known;
  require_content(path);
  const std::string name = input_name(path);
  const std::string foreign = foreign_format(head_of(path));
  if (!foreign.empty()) {
    throw Error{Fault::data, name + ": is " + foreign +
                                 "; a volume (VDB), a stack (EXR), a video (MKV, MP4) or a folder of images "
                                 "is needed" +
                                 foreign_remedy(head_of(path))};
  }
  throw Error{Fault::data, name + ": neither a volume (VDB), a stack (EXR), a video (MKV, MP4) nor a folder of images"};
}

}  // namespace vam::io
