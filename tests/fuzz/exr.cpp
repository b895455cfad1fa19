// SPDX-License-Identifier: GPL-3.0-or-later
// A stack out of FUZZ_SOURCE, File or Pipe, image by image to its end, as the child reads it.
#include "fuzz/fuzz.hpp"
#include "io/exr/private/stack_parser.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  if (size > fuzz::Pipe::room) return -1;
  const fuzz::FUZZ_SOURCE source(fuzz::text_of(bytes, size));
  return fuzz::attempt_in_child([&] {
    vam::io::exr::StackParser parser(source.path, true);
    vam::Image image;
    vam::model::ImageInfo about;
    do {
      parser.read_head();
      while (parser.next(image, about)) {
      }
    } while (parser.next_stack());
  });
}
