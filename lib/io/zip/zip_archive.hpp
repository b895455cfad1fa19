// SPDX-License-Identifier: GPL-3.0-or-later
// Files inside a zip archive in memory.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

struct zip;
struct zip_file;

namespace vam::io {

/// All throw std::runtime_error, to stand behind the file's name.
class ZipArchive {
 public:
  /// The bytes must outlive it; messages call it `kind`, "3MF". no_case: names that differ in capitals alone are the
  /// same. Throws for what is no zip archive, cut off or damaged, has bytes before or behind it, or two files of a
  /// name.
  ZipArchive(std::string_view bytes, std::string kind, bool no_case);

  [[nodiscard]] const std::vector<std::string>& names() const { return names_; }
  [[nodiscard]] bool has(const std::string& name) const;
  /// From here on read() unpacks this file. Returns the bytes that it is stated to have. Throws where there is none.
  std::uint64_t open(const std::string& name);
  /// Fewer than `size` only at the end, where the checksum is held to.
  std::size_t read(void* to, std::size_t size);

 private:
  [[noreturn]] void damaged(const std::string& why) const;

  struct Close {
    void operator()(zip* archive) const;
    void operator()(zip_file* file) const;
  };
  std::string kind_;
  unsigned flags_;
  std::unique_ptr<zip, Close> archive_;
  std::unique_ptr<zip_file, Close> file_;
  std::vector<std::string> names_;
};

}  // namespace vam::io
