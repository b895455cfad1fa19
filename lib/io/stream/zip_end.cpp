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

std::uint64_t bytes_before_zip(std::string_view bytes) {
  constexpr std::size_t record = 22, size_at = 12, start_at = 16, length_at = 20;
  const auto number = [&](std::size_t at, int count) {
    std::uint64_t value = 0;
    for (int i = count; i-- > 0;)
      value = value << 8 | static_cast<unsigned char>(bytes[at + static_cast<std::size_t>(i)]);
    return value;
  };
  for (std::size_t at = bytes.rfind("PK\5\6"); at != std::string_view::npos; at = bytes.rfind("PK\5\6", at - 1)) {
    const bool last = bytes.size() - at >= record && at + record + number(at + length_at, 2) == bytes.size();
    const std::uint64_t end = last ? number(at + size_at, 4) + number(at + start_at, 4) : 0;
    if (last)
      return number(at + start_at, 4) == 0xffffffff || end > at ? 0 : at - end;  // of ZIP64 the start is elsewhere
    if (at == 0) break;
  }
  return 0;
}

}  // namespace vam::io
