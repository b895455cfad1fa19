// SPDX-License-Identifier: GPL-3.0-or-later
// What a Matroska file says of its own wholeness.
#include "fuzz/fuzz.hpp"
#include "io/image/private/matroska.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  const fuzz::File file(fuzz::text_of(bytes, size));
  return fuzz::attempt([&] { vam::io::require_whole_matroska(file.path); });
}
