// SPDX-License-Identifier: GPL-3.0-or-later
// Private to capture folders: the manifest's name, and the seal of a line.
#pragma once

#include <string>

#include "base/json_fwd.hpp"
#include "io/stream/seal.hpp"

namespace vam::io {

inline constexpr const char* manifest_seal_key = "seal";

[[nodiscard]] std::string manifest_path(const std::string& folder);

/// Of a line but for its seal, behind one that has the seal `before`; that of the first is behind none.
[[nodiscard]] Digest manifest_seal(const Digest& before, const Json& line);

}  // namespace vam::io
