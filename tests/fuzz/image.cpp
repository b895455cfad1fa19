// SPDX-License-Identifier: GPL-3.0-or-later
// An image file, as the child decodes it.
#include "fuzz/fuzz.hpp"
#include "io/image/private/decoders.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  const std::string file = fuzz::text_of(bytes, size);
  return fuzz::attempt_in_child([&] { (void)vam::io::FUZZ_DECODE(file, "image"); });
}
