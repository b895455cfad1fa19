// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/stream/zip_end.hpp"

#include <algorithm>

namespace vam::io {

std::uint64_t bytes_behind_zip(std::string_view bytes) {
  constexpr std::string_view mark = "PK\5\6";
  constexpr std::size_t record = 22, length_at = 20, most_comment = 0xffff;
  std::uint64_t least = 0;
  const std::size_t first = bytes.size() - std::min(bytes.size(), 2 * (record + most_comment));
  for (std::size_t at = bytes.rfind(mark); at != bytes.npos && at >= first; at = bytes.rfind(mark, at - 1)) {
    if (bytes.size() - at >= record) {
      const auto low = static_cast<unsigned char>(bytes[at + length_at]);
      const auto high = static_cast<unsigned char>(bytes[at + length_at + 1]);
      const std::size_t end = at + record + (std::size_t{high} << 8 | low);
      if (end == bytes.size()) return 0;  // what looks like one may stand in a comment
      if (end < bytes.size() && least == 0) least = bytes.size() - end;
    }
    if (at == 0) break;
  }
  return least;
}

}  // namespace vam::io
