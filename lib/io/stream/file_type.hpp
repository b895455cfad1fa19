// SPDX-License-Identifier: GPL-3.0-or-later
// What a file is, by its first bytes.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace vam::io {

enum class FileType {
  volume,  // OpenVDB
  stack,   // OpenEXR
  video,   // Matroska or MP4
  images,  // a folder
};

/// Peeks without consuming, so that the next reader receives every byte; "-" is stdin, a file or a pipe.
/// Throws Error: no_input, data (none of these).
[[nodiscard]] FileType file_type(const std::string& path);

/// The same; nothing for a file that is none of these.
[[nodiscard]] std::optional<FileType> known_file_type(const std::string& path);

/// Is it an array that is alone in its file: NumPy's (.npy), NRRD or TIFF? Throws Fault::no_input.
[[nodiscard]] bool is_lone_array(const std::string& path);

/// Throws Error: no_input, data (a file or pipe without bytes).
void require_content(const std::string& path);

/// Where a mesh may stand as well: is it a volume? Throws Fault::no_input.
[[nodiscard]] bool is_volume(const std::string& path);

/// "a NumPy array (.npy)", "compressed by gzip": fits behind "is". Empty for bytes without a known signature. 400 bytes
/// suffice, but for XML whose root element comes later.
[[nodiscard]] std::string foreign_format(std::string_view head);

/// What makes such a file readable: "; unpack it", the end of a message. Empty where nothing does.
[[nodiscard]] std::string foreign_remedy(std::string_view head);

}  // namespace vam::io
