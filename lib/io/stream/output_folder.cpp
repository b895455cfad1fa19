// SPDX-License-Identifier: GPL-3.0-or-later
#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <fstream>
#include <system_error>

#include "base/error.hpp"
#include "base/system_error.hpp"
#include "io/stream/private/temporary.hpp"
#include "io/stream/stream.hpp"

namespace vam::io {

namespace fs = std::filesystem;

namespace {

void check_replaceable(const fs::path& folder, bool (*like_these)(const fs::path&)) {
  if (!fs::exists(folder)) return;
  if (!fs::is_directory(folder)) throw Error{Fault::no_output, folder.string() + ": exists and is not a folder"};
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (!like_these(entry.path())) {
      throw Error{Fault::no_output, folder.string() + ": holds " + entry.path().filename().string() +
                                        ", which is not a frame; use another folder"};
    }
  }
}

}  // namespace

OutputFolder::OutputFolder(const std::string& path, bool (*like_these)(const fs::path& file))
    : target_(fs::path(path).has_filename() ? fs::path(path) : fs::path(path).parent_path()) {
  check_replaceable(target_, like_these);
  if (create_temporary_folder(target_.string(), temporary_, slot_) != 0) {
    throw system_error(Fault::no_output, target_.string() + ": cannot create the folder", errno);
  }
}

OutputFolder::~OutputFolder() { discard(); }

void OutputFolder::discard() {
  const std::string folder = temporary_;
  std::error_code problem;
  if (!folder.empty()) fs::remove_all(folder, problem);
  forget();
  if (problem) fs::remove_all(folder, problem);  // with the descriptor of its lock, which may be the last
}

void OutputFolder::forget() {
  forget_temporary(slot_);
  slot_ = -1;
  temporary_.clear();
}

void OutputFolder::write(const std::string& name, std::string_view bytes) const {
  std::ofstream file(fs::path(temporary_) / name, std::ios::binary);
  if (!file) throw system_error(Fault::no_output, (target_ / name).string() + ": cannot create", errno);
  file.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  file.close();
  if (!file) throw Error{Fault::io, (target_ / name).string() + ": cannot write; check the free space on the disk"};
}

// One call for the whole folder, in place of an fsync for each of a thousand files.
void OutputFolder::synchronize() const {
  const int folder = ::open(temporary_.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (folder < 0) throw system_error(Fault::io, target_.string() + ": cannot finish", errno);
  const bool done = syncfs(folder) == 0;
  ::close(folder);
  if (!done)
    throw Error{Fault::io, target_.string() + ": not all files were written; check the free space on the disk"};
}

void OutputFolder::commit() {
  synchronize();
  if (renameat2(AT_FDCWD, temporary_.c_str(), AT_FDCWD, target_.c_str(), RENAME_EXCHANGE) == 0) {
    synchronise_folder_of(target_.string());
    return discard();  // the old files, which have the temporary name now
  }
  // There are none, or the file system cannot exchange names.
  std::error_code problem;
  const std::string old = temporary_ + "-old";
  const bool replaces = fs::exists(target_);
  // The old files step aside, and come back if the new ones cannot take their place.
  if (replaces) fs::rename(target_, old, problem);
  if (!problem) fs::rename(temporary_, target_, problem);
  if (problem) {
    std::error_code ignored;
    if (replaces && !fs::exists(target_)) fs::rename(old, target_, ignored);
    throw Error{Fault::no_output, target_.string() + ": cannot put the folder in place: " + problem.message()};
  }
  synchronise_folder_of(target_.string());
  forget();
  if (replaces) fs::remove_all(old, problem);
}

}  // namespace vam::io
