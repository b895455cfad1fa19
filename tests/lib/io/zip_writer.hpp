// SPDX-License-Identifier: GPL-3.0-or-later
// A zip archive of stored and packed files, so that the 3MF reader is judged by bytes of our own.
#pragma once

#include <zlib.h>

#include <cstdint>
#include <cstring>
#include <string>

namespace samples {

template <class T>
std::string little(T value) {
  std::string bytes(sizeof value, '\0');
  std::memcpy(bytes.data(), &value, sizeof value);
  return bytes;
}

inline std::uint32_t crc32(const std::string& bytes) {
  std::uint32_t crc = ~0U;
  for (const char c : bytes) {
    crc ^= static_cast<std::uint8_t>(c);
    for (int bit = 0; bit < 8; ++bit) crc = (crc >> 1) ^ (0xEDB88320U & (0U - (crc & 1U)));
  }
  return ~crc;
}

/// By deflate, without the head of a zlib stream.
inline std::string packed(const std::string& bytes) {
  z_stream stream{};
  deflateInit2(&stream, 6, Z_DEFLATED, -MAX_WBITS, 8, Z_DEFAULT_STRATEGY);
  std::string made(deflateBound(&stream, bytes.size()), '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
  stream.avail_in = static_cast<uInt>(bytes.size());
  stream.next_out = reinterpret_cast<Bytef*>(made.data());
  stream.avail_out = static_cast<uInt>(made.size());
  deflate(&stream, Z_FINISH);
  made.resize(stream.total_out);
  deflateEnd(&stream);
  return made;
}

struct Zip {
  std::string bytes;
  std::string directory;
  std::uint16_t files = 0;
  void add(const std::string& name, const std::string& content) { put(name, content, content, 0); }
  void add_packed(const std::string& name, const std::string& content) { put(name, content, packed(content), 8); }
  void put(const std::string& name, const std::string& content, const std::string& data, std::uint16_t method) {
    const std::string common = little<std::uint16_t>(20) + little<std::uint16_t>(0) + little(method) +
                               little<std::uint32_t>(0x21) + little(crc32(content)) +
                               little(static_cast<std::uint32_t>(data.size())) +
                               little(static_cast<std::uint32_t>(content.size())) +
                               little(static_cast<std::uint16_t>(name.size())) + little<std::uint16_t>(0);
    directory += "PK\1\2" + little<std::uint16_t>(20) + common + std::string(6, '\0') + little<std::uint32_t>(0) +
                 little(static_cast<std::uint32_t>(bytes.size())) + name;
    bytes += "PK\3\4" + common + name + data;
    ++files;
  }
  [[nodiscard]] std::string done() const {
    return bytes + directory + "PK\5\6" + little<std::uint32_t>(0) + little(files) + little(files) +
           little(static_cast<std::uint32_t>(directory.size())) + little(static_cast<std::uint32_t>(bytes.size())) +
           little<std::uint16_t>(0);
  }
};

}  // namespace samples
