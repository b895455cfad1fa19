// SPDX-License-Identifier: GPL-3.0-or-later
// Files inside a zip archive in memory.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

struct zip;

namespace vam::io {

class ZipArchive {
 public:
  /// The bytes must outlive it. Throws MeshProblem: no zip archive, cut off, damaged, two files whose
  /// names differ in capitals at most.
  explicit ZipArchive(std::string_view bytes);

  [[nodiscard]] bool has(const std::string& name) const;
  /// The name of the first file that ends in `suffix`; empty when there is none.
  [[nodiscard]] std::string first_with(std::string_view suffix) const;
  /// Passes a file by, unpacked, some 64 KiB at a time; its checksum is held to. Throws MeshProblem: no such file,
  /// damaged, more in all than 64 MiB and 64 times the archive.
  void read(const std::string& name, const std::function<void(std::string_view)>& take);

 private:
  struct Close {
    void operator()(zip* archive) const;
  };
  std::unique_ptr<zip, Close> archive_;
  std::uint64_t left_;  // bytes that may yet be unpacked
};

}  // namespace vam::io
