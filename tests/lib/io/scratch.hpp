// SPDX-License-Identifier: GPL-3.0-or-later
// What the tests of files need: a folder that vanishes, the fault that work throws, standard streams led elsewhere.
#pragma once

#include <fcntl.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "base/error.hpp"

namespace scratch {

/// An empty folder, removed with its contents at the end of the test.
struct Folder {
  Folder() {
    std::string name = (std::filesystem::temp_directory_path() / "vam-test-XXXXXX").string();
    path = mkdtemp(name.data());
  }
  ~Folder() { std::filesystem::remove_all(path); }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  std::string operator/(const std::string& name) const { return (path / name).string(); }
  /// Names in it, hidden ones included.
  [[nodiscard]] int count() const {
    return static_cast<int>(
        std::distance(std::filesystem::directory_iterator(path), std::filesystem::directory_iterator{}));
  }
  /// A new file there; its path.
  [[nodiscard]] std::string write(const std::string& name, const std::string& bytes) const {
    std::ofstream(path / name, std::ios::binary) << bytes;
    return *this / name;
  }
  std::filesystem::path path;
};

inline std::string slurp(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

inline void spill(const std::string& path, const std::string& bytes) { std::ofstream(path, std::ios::binary) << bytes; }

/// The exit status that work ends with: 0, that of its Error, or -1 for any other exception. The line is kept.
template <class Work>
int status(const Work& work, std::string* line = nullptr) {
  try {
    work();
    return 0;
  } catch (const vam::Error& error) {
    if (line != nullptr) *line = error.what();
    return static_cast<int>(error.fault);
  } catch (const std::exception& other) {
    if (line != nullptr) *line = other.what();
    return -1;
  }
}

/// Standard stream `descriptor` leads to a file for as long as this lives.
struct Redirect {
  Redirect(int descriptor, const std::string& path) : standard(descriptor), saved(dup(descriptor)) {
    std::fflush(nullptr);
    const int file = open(path.c_str(), standard == STDIN_FILENO ? O_RDONLY : O_WRONLY | O_CREAT | O_TRUNC, 0666);
    dup2(file, standard);
    close(file);
  }
  ~Redirect() {
    dup2(saved, standard);
    close(saved);
  }
  Redirect(const Redirect&) = delete;
  Redirect& operator=(const Redirect&) = delete;
  int standard;
  int saved;
};

}  // namespace scratch
