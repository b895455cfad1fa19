// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/array/private/array_bytes.hpp"

#include <stdexcept>

namespace vam::io::arrays {

namespace {

constexpr std::size_t most_line = 1 << 16;

}  // namespace

void Bytes::take(void* to, std::size_t size) {
  const std::size_t got = read_(to, size);
  taken_ += got;
  if (got == size) return;
  throw std::runtime_error("is cut off after " + std::to_string(taken_) +
                           " bytes; the program that wrote it did not finish");
}

std::string Bytes::line() {
  std::string text;
  for (char next = 0;;) {
    take(&next, 1);
    if (next == '\n') break;
    text += next;
    if (text.size() > most_line) {
      throw std::runtime_error("its header is damaged: a line has more than 65536 characters");
    }
  }
  if (text.ends_with('\r')) text.pop_back();
  return text;
}

bool Bytes::ended() {
  char more = 0;
  return read_(&more, 1) == 0;
}

}  // namespace vam::io::arrays
