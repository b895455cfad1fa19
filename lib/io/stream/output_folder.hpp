// SPDX-License-Identifier: GPL-3.0-or-later
// A folder of files that appears under its name only when it is complete.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace vam::io {

/// The files are written beside the target, in a hidden folder that the destructor and SIGHUP, SIGINT and SIGTERM
/// remove; commit() puts it in place. An older folder is replaced if it is empty or holds nothing but files like these.
class OutputFolder {
 public:
  /// `like_these` tells by its name whether a file of an older folder may go. Throws Error: no_output (the folder holds
  /// something else, cannot be created).
  OutputFolder(const std::string& path, bool (*like_these)(const std::filesystem::path& file));
  ~OutputFolder();
  OutputFolder(const OutputFolder&) = delete;
  OutputFolder& operator=(const OutputFolder&) = delete;

  /// Writes a whole file; several threads may write different ones. Throws Error: io.
  void write(const std::string& name, std::string_view bytes) const;
  /// Waits for the disk and puts the folder under its name. Throws Error: io, no_output.
  void commit();

 private:
  void synchronize() const;
  void discard();
  void forget();
  std::filesystem::path target_;
  std::string temporary_;
  int slot_ = -1;
};

}  // namespace vam::io
