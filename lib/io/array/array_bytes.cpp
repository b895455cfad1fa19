// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/array/private/array_bytes.hpp"

#include <stdexcept>
#include <utility>
#include <vector>

#include "base/error.hpp"

namespace vam::io::arrays {

namespace {

constexpr std::size_t most_line = 1 << 16;

}  // namespace

Bytes::Bytes(Read read, std::string name) : read_(std::move(read)), name_(std::move(name)) {}

void Bytes::fail(const std::string& why) const { throw Error{Fault::data, name_ + ": " + why}; }

void Bytes::take(void* to, std::size_t size) {
  const std::size_t got = read_(to, size);
  taken_ += got;
  if (got == size) return;
  fail("is cut off after " + std::to_string(taken_) + " bytes; the program that wrote it did not finish");
}

std::string Bytes::line() {
  std::string text;
  for (char next = 0;;) {
    take(&next, 1);
    if (next == '\n') break;
    text += next;
    if (text.size() > most_line) fail("its header is damaged: a line has more than 65536 characters");
  }
  if (text.ends_with('\r')) text.pop_back();
  return text;
}

bool Bytes::ended() {
  char more = 0;
  return read_(&more, 1) == 0;
}

void set_shape(const Bytes& bytes, const std::vector<std::uint64_t>& shape, Head& head) {
  try {
    set_shape(shape, head);
  } catch (const std::runtime_error& problem) {
    bytes.fail(problem.what());
  }
}

}  // namespace vam::io::arrays
