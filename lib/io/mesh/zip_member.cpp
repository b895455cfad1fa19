#include "io/mesh/private/zip_member.hpp"

#include <zlib.h>

#include <algorithm>
#include <cstdint>

namespace vam::io {

namespace {

// Little-endian number of `size` bytes at `at`; 0 beyond the end.
std::size_t number(std::string_view bytes, std::size_t at, std::size_t size) {
  std::size_t value = 0;
  for (std::size_t i = size; i-- > 0;) {
    value = value << 8 | (at + i < bytes.size() ? static_cast<std::uint8_t>(bytes[at + i]) : 0U);
  }
  return value;
}

std::string_view part(std::string_view bytes, std::size_t at, std::size_t size) {
  return at < bytes.size() ? bytes.substr(at, size) : std::string_view{};
}

std::optional<std::string> inflated_head(std::string_view deflated, std::size_t limit) {
  z_stream stream{};
  if (inflateInit2(&stream, -MAX_WBITS) != Z_OK) return std::nullopt;  // negative: raw deflate, as zip has it
  std::string head(limit, '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(deflated.data()));
  stream.avail_in = static_cast<uInt>(std::min<std::size_t>(deflated.size(), 1U << 30));
  stream.next_out = reinterpret_cast<Bytef*>(head.data());
  stream.avail_out = static_cast<uInt>(limit);
  const int status = inflate(&stream, Z_SYNC_FLUSH);
  head.resize(limit - stream.avail_out);
  inflateEnd(&stream);
  return status == Z_OK || status == Z_STREAM_END || status == Z_BUF_ERROR ? std::optional(head) : std::nullopt;
}

}  // namespace

std::optional<std::string> zip_member_head(std::string_view archive, std::string_view suffix, std::size_t limit) {
  const std::size_t end = archive.rfind("PK\5\6");  // end of the central directory (APPNOTE.TXT 4.3.16)
  if (end == std::string_view::npos) return std::nullopt;
  std::size_t entry = number(archive, end + 16, 4);
  for (std::size_t left = number(archive, end + 10, 2); left > 0; --left) {  // 4.3.12
    if (part(archive, entry, 4) != "PK\1\2") return std::nullopt;
    const std::size_t name_size = number(archive, entry + 28, 2);
    if (part(archive, entry + 46, name_size).ends_with(suffix)) break;
    entry += 46 + name_size + number(archive, entry + 30, 2) + number(archive, entry + 32, 2);
  }
  if (part(archive, entry, 4) != "PK\1\2") return std::nullopt;
  const std::size_t method = number(archive, entry + 10, 2);
  const std::size_t local = number(archive, entry + 42, 4);  // 4.3.7: the data follow a name and extra field of its own
  const std::size_t data = local + 30 + number(archive, local + 26, 2) + number(archive, local + 28, 2);
  const std::string_view packed = part(archive, data, number(archive, entry + 20, 4));
  if (method == 0) return std::string(packed.substr(0, limit));
  return method == 8 ? inflated_head(packed, limit) : std::nullopt;
}

}  // namespace vam::io
