// A zip archive of stored files, so that the 3MF reader is judged by bytes of our own.
#pragma once

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

struct Zip {
  std::string bytes;
  std::string directory;
  std::uint16_t files = 0;
  void add(const std::string& name, const std::string& content) {
    const auto size = static_cast<std::uint32_t>(content.size());
    const std::string common = little<std::uint16_t>(20) + little<std::uint16_t>(0) + little<std::uint16_t>(0) +
                               little<std::uint32_t>(0x21) + little(crc32(content)) + little(size) + little(size) +
                               little(static_cast<std::uint16_t>(name.size())) + little<std::uint16_t>(0);
    directory += "PK\1\2" + little<std::uint16_t>(20) + common + std::string(6, '\0') + little<std::uint32_t>(0) +
                 little(static_cast<std::uint32_t>(bytes.size())) + name;
    bytes += "PK\3\4" + common + name + content;
    ++files;
  }
  [[nodiscard]] std::string done() const {
    return bytes + directory + "PK\5\6" + little<std::uint32_t>(0) + little(files) + little(files) +
           little(static_cast<std::uint32_t>(directory.size())) + little(static_cast<std::uint32_t>(bytes.size())) +
           little<std::uint16_t>(0);
  }
};

}  // namespace samples
