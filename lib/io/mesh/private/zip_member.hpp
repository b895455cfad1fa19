// The beginning of one file inside a zip archive.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace vam::io {

/// At most `limit` bytes of the first member whose name ends in `suffix`, stored or deflated; nothing when there is no
/// such member, or when the archive is cut or damaged.
[[nodiscard]] std::optional<std::string> zip_member_head(std::string_view archive, std::string_view suffix,
                                                         std::size_t limit);

}  // namespace vam::io
