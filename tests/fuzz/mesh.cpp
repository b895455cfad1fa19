// SPDX-License-Identifier: GPL-3.0-or-later
// One parser of meshes, FUZZ_PARSE, as the child calls it.
#include "fuzz/fuzz.hpp"
#include "io/mesh/private/formats.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  return fuzz::attempt_in_child([&] { (void)vam::io::FUZZ_PARSE(fuzz::text_of(bytes, size)); });
}
