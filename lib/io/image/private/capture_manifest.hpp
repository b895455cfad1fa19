// SPDX-License-Identifier: GPL-3.0-or-later
// Private to capture folders: the manifest's name, the seal of a line, and images that have none.
#pragma once

#include <set>
#include <string>

#include "base/text/json_fwd.hpp"
#include "io/image/capture_folder.hpp"
#include "io/stream/seal.hpp"

namespace vam::io {

inline constexpr const char* manifest_seal_key = "seal";

[[nodiscard]] std::string manifest_path(const std::string& folder);

/// Of a line but for its seal, behind one that has the seal `before`; that of the first is behind none.
[[nodiscard]] Digest manifest_seal(const Digest& before, const Json& line);

/// Names of the images in the folder. Throws Fault::no_input.
[[nodiscard]] std::set<std::string> images_of(const std::string& folder);
/// Those of them that the manifest does not list.
[[nodiscard]] std::set<std::string> unlisted(const CaptureManifest& manifest, std::set<std::string> images);
/// What is wrong with such images, as a line.
[[nodiscard]] std::string without_line(const std::string& folder, const std::set<std::string>& names);

}  // namespace vam::io
